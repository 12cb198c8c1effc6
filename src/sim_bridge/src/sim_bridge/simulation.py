"""The facade: one robot in one world, stepped."""

import math
from dataclasses import dataclass
from typing import Optional, Tuple

import numpy as np

from planar import Pose2, Scan, Twist2
from sim_bridge.config import SimulationSettings
from sim_bridge.drive import Drive
from sim_bridge.errors import WorldError
from sim_bridge.lidar import Lidar
from sim_bridge.odometry import DeadReckoning, Odometry
from sim_bridge.physics import Physics
from sim_bridge.pose3 import from_pose2, to_pose2
from sim_bridge.robots import ROBOTS, RobotProfile
from sim_bridge.section import Section
from sim_bridge.shapes import Box
from sim_bridge.world import Body, Collision, World


@dataclass(frozen=True, eq=False)
class Observation:
    """What there is to know after a step.

    ``stamp``: simulated seconds since the start. ``base_in_world`` and ``twist`` are the truth, ``odometry``
    and ``scan`` (None if none is due) what the robot measures. ``wheel_angles``, ``wheel_speeds``: left and
    right, rad and rad/s. ``contacts``: names (``model::link``) of what the robot has bumped into since the
    last step. ``tilt``: between the robot's axis and the vertical, rad.
    """

    stamp: float
    base_in_world: Pose2
    twist: Twist2
    odometry: Odometry
    scan: Optional[Scan]
    contacts: Tuple[str, ...]
    wheel_angles: Tuple[float, float]
    wheel_speeds: Tuple[float, float]
    tilt: float


class Simulation:
    """A robot that starts at ``base_in_world``. The same seed and commands give the same observations.

    Raises WorldError if the robot cannot stand there.
    """

    def __init__(
        self,
        world: World,
        robot: RobotProfile = ROBOTS["turtlebot_lidar"],
        settings: SimulationSettings = SimulationSettings(),
        seed: int = 0,
        base_in_world: Pose2 = Pose2(),
    ):
        odometry_rng, lidar_rng = (np.random.default_rng([seed, stream]) for stream in range(2))
        laser_in_base = robot.mounting(robot.laser.frame)
        self._physics = Physics(robot, base_in_world, settings.physics_rate, world.gravity)
        self._section = Section(height=float(laser_in_base[2, 3]))
        for body in world.bodies:
            self._add(body)
        self._physics.check_start()
        self._drive = Drive(robot.drive, settings.command_timeout)
        self._dead_reckoning = DeadReckoning(robot.drive, settings, odometry_rng)
        self._lidar = Lidar(robot.laser, laser_in_base, settings.range_noise, lidar_rng)
        self._settings = settings
        self._physics_steps = 0

    @property
    def step_seconds(self) -> float:
        """Simulated seconds that a step takes: the period of the odometry."""
        return 1.0 / self._settings.odometry_rate

    def step(self, command: Optional[Twist2] = None) -> Observation:
        """Moves on by one period of the odometry; the last ``command`` holds until its time-out."""
        if command is not None:
            self._drive.command(command)
        rate = self._settings.physics_rate
        scan, touched = None, set()
        for _ in range(rate // self._settings.odometry_rate):
            self._physics.step(self._drive.wheel_speeds(1.0 / rate))
            self._physics_steps += 1
            touched.update(self._physics.touched())
            if self._physics_steps % (rate // self._settings.scan_rate) == 0:
                scan = self._sweep()
        base_in_space = self._physics.base_in_space()
        twist = self._physics.twist_in_base(base_in_space)
        wheel_angles, wheel_speeds = self._physics.wheels()
        return Observation(
            stamp=self._physics_steps / rate,
            base_in_world=to_pose2(base_in_space),
            twist=twist,
            odometry=self._dead_reckoning.update(wheel_angles, twist.omega, self.step_seconds),
            scan=scan,
            contacts=tuple(sorted(touched)),
            wheel_angles=wheel_angles,
            wheel_speeds=wheel_speeds,
            tilt=math.acos(min(base_in_space[2, 2], 1.0)),
        )

    def add_box(
        self, name: str, size: Tuple[float, float, float], pose: Pose2, mass: Optional[float] = None
    ) -> None:
        """Puts a box on the floor, ``size`` in metres; it stays where it is unless it has a ``mass``, kg.

        Raises WorldError if the name is taken or the box has no size or place.
        """
        if not (all(0.0 < length < math.inf for length in size) and pose.is_finite()):
            raise WorldError(f"{name}: a box needs positive lengths and a place, got {size} at {pose}")
        in_world = from_pose2(pose, z=size[2] / 2.0)
        self._add(Body(f"{name}::link", in_world, (Collision(Box(size), np.eye(4)),), mass))

    def close(self) -> None:
        """Frees the physics engine."""
        self._physics.close()

    def _add(self, body: Body) -> None:
        self._physics.add(body)
        self._section.add(body)

    def _sweep(self) -> Scan:
        return self._lidar.sweep(
            self._physics_steps / self._settings.physics_rate,
            self._section.segments(self._physics.pose_of),
            to_pose2(self._physics.base_in_space()),
        )
