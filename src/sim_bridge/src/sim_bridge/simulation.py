"""The simulator's facade: one robot in one world."""

import warnings
from typing import Optional, Tuple

import numpy as np

from planar import Pose2, Twist2
from planar.geometry.limits import MAX_COORDINATE
from sim_bridge.config import SimulationSettings
from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.geometry.shapes import Box
from sim_bridge.robot import RobotWrappers, StepResult
from sim_bridge.robots import ROBOTS, RobotProfile
from sim_bridge.scene import Scene
from sim_bridge.world import Body, Collision, World

# The model name of Gazebo's TurtleBot.
ROBOT_NAME = "mobile_base"


class Simulation:
    """A simulation of one robot. The same world, seed and commands give the same results, bit for bit.

    Args:
        world: The world.
        robot: The robot's parts, drive and sensors.
        settings: Rates and noise.
        seed: Seed of all noise.
        base_in_world: Start pose of the robot's base.
        wrappers: Wrap the robot's sensors and drive, e.g. to inject faults.
        fitting: Deprecated name of ``wrappers``.

    Attributes:
        scene: The world with the robot in it, for everything beyond this facade.

    Raises:
        WorldError: The robot cannot stand at the start pose.
    """

    def __init__(
        self,
        world: World,
        robot: RobotProfile = ROBOTS["turtlebot_lidar"],
        settings: SimulationSettings = SimulationSettings(),
        seed: int = 0,
        base_in_world: Pose2 = Pose2(),
        wrappers: RobotWrappers = RobotWrappers(),
        fitting: Optional[RobotWrappers] = None,
    ):
        if fitting is not None:
            warnings.warn("fitting is deprecated; use wrappers", DeprecationWarning, stacklevel=2)
            wrappers = fitting
        self.scene = Scene(world, settings, seed, wrappers)
        self.scene.add_robot(ROBOT_NAME, robot, base_in_world)

    @property
    def base(self) -> str:
        """Name of the robot's base link, ``model::link``."""
        return self.scene.models.links_of(ROBOT_NAME)[0]

    @property
    def step_seconds(self) -> float:
        """Simulated duration of a step [s]: the period of the odometry."""
        return self.scene.step_seconds

    def step(self, command: Optional[Twist2] = None) -> StepResult:
        """Advance the simulation by one period of the odometry.

        Args:
            command: Velocity command; None keeps the last one, which holds until the drive's time-out.

        Returns:
            Sensor readings and ground truth at the end of the step.
        """
        return self.scene.step({} if command is None else {ROBOT_NAME: command})[ROBOT_NAME]

    def park(self) -> bool:
        """Stop physics while nothing moves; see ``Scene.park``."""
        return self.scene.park()

    def skip(self, seconds: float) -> None:
        """Advance a parked simulation without measurements; see ``Scene.skip``.

        Args:
            seconds: Duration, rounded to whole periods of the odometry [s].
        """
        self.scene.skip(round(seconds / self.step_seconds))

    def wake(self) -> None:
        """Let physics go on; see ``Scene.wake``."""
        self.scene.wake()

    def mark(self) -> None:
        """Save the present state, with the robot at rest, for ``rewind``."""
        self.scene.mark()

    def rewind(self, seed: int, base_in_world: Optional[Pose2] = None) -> None:
        """Restart at time 0 from the state that ``mark`` saved; takes well under a millisecond.

        Args:
            seed: Seed of all noise from now on.
            base_in_world: Start pose of the robot; None for the one in the marked state.
        """
        self.scene.rewind(seed, {} if base_in_world is None else {ROBOT_NAME: base_in_world})

    def add_box(
        self, name: str, size: Tuple[float, float, float], pose: Pose2, mass: Optional[float] = None
    ) -> None:
        """Put a box on the floor.

        Args:
            name: Name of the new model.
            size: Lengths along x, y and z [m].
            pose: Pose of its centre in the world.
            mass: Mass [kg]; None for a static box.

        Raises:
            WorldError: The name is taken, or the size or pose is not valid.
        """
        self.scene.add([box_on_floor(name, size, pose, mass)])

    def close(self) -> None:
        """Free the physics engine."""
        self.scene.close()


def box_on_floor(
    name: str,
    size: Tuple[float, float, float],
    pose: Pose2,
    mass: Optional[float] = None,
    height: float = 0.0,
) -> Body:
    """Return the body of a box model that stands at a height.

    Args:
        name: Name of the model.
        size: Lengths along x, y and z [m].
        pose: Pose of its centre in the world.
        mass: Mass [kg]; None for a static box.
        height: Height of its bottom above the world's origin [m].

    Raises:
        WorldError: The size or pose is not valid.
    """
    if not (all(0.0 < length < MAX_COORDINATE for length in size) and pose.is_in_range()):
        raise WorldError(f"{name}: a box needs positive lengths and a valid pose, got {size} at {pose}")
    in_world = from_pose2(pose, z=height + size[2] / 2.0)
    return Body(f"{name}::link", in_world, (Collision(Box(size), np.eye(4)),), mass)
