"""The facade: one robot in one world, stepped."""

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

# Gazebo's TurtleBot is called so.
ROBOT_NAME = "mobile_base"


class Simulation:
    """A robot that starts at ``base_in_world``. The same seed and commands give the same observations.

    ``fitting``: what is put before its sensors and its drive. Raises WorldError if it cannot stand there.
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
        """The name of the link that the robot's pose is told by."""
        return self.scene.models.links_of(ROBOT_NAME)[0]

    @property
    def step_seconds(self) -> float:
        """Simulated seconds that a step takes: the period of the odometry."""
        return self.scene.step_seconds

    def step(self, command: Optional[Twist2] = None) -> StepResult:
        """Moves on by one period of the odometry; the last ``command`` holds until its time-out."""
        return self.scene.step({} if command is None else {ROBOT_NAME: command})[ROBOT_NAME]

    def mark(self) -> None:
        """Keeps all as it is now, with the robot at rest, for ``rewind``."""
        self.scene.mark()

    def rewind(self, seed: int, base_in_world: Optional[Pose2] = None) -> None:
        """Starts again at time 0 from what was marked, in well under a millisecond; see Scene.rewind.

        ``base_in_world``: where the robot starts; None: where it did.
        """
        self.scene.rewind(seed, {} if base_in_world is None else {ROBOT_NAME: base_in_world})

    def add_box(
        self, name: str, size: Tuple[float, float, float], pose: Pose2, mass: Optional[float] = None
    ) -> None:
        """Puts a box on the floor, ``size`` in metres; it stays where it is unless it has a ``mass``, kg.

        Raises WorldError if the name is taken or the box has no size or place.
        """
        self.scene.add([box_on_floor(name, size, pose, mass)])

    def close(self) -> None:
        """Frees the physics engine."""
        self.scene.close()


def box_on_floor(
    name: str,
    size: Tuple[float, float, float],
    pose: Pose2,
    mass: Optional[float] = None,
    height: float = 0.0,
) -> Body:
    """A model of one box, ``size`` in metres, whose bottom is at ``height``. Raises WorldError if it has no
    size or place.
    """
    if not (all(0.0 < length < MAX_COORDINATE for length in size) and pose.is_in_range()):
        raise WorldError(f"{name}: a box needs positive lengths and a place, got {size} at {pose}")
    in_world = from_pose2(pose, z=height + size[2] / 2.0)
    return Body(f"{name}::link", in_world, (Collision(Box(size), np.eye(4)),), mass)
