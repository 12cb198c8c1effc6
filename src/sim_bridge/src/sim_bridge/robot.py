"""A robot in its scene: it is commanded, it moves, it measures."""

import math
from dataclasses import dataclass
from typing import Iterable, Optional, Sequence, Set, Tuple

import numpy as np

from planar import Pose2, Scan, Twist2
from sim_bridge.config import SimulationSettings
from sim_bridge.drive import Drive
from sim_bridge.engine import Engine
from sim_bridge.odometry import DeadReckoning, Odometry
from sim_bridge.pose3 import from_pose2, to_pose2
from sim_bridge.robots import RobotProfile
from sim_bridge.section import Section
from sim_bridge.sensors.lidar import Lidar
from sim_bridge.vehicle import Vehicle, twist_in_base
from sim_bridge.world import Body


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


class Robot:
    """The robot ``name`` at ``base_in_world`` on the floor z = 0; ``seed``: of its sensors' noise."""

    def __init__(
        self,
        engine: Engine,
        name: str,
        profile: RobotProfile,
        base_in_world: Pose2,
        settings: SimulationSettings,
        seed: Sequence[int],
    ):
        odometry_rng, lidar_rng = (np.random.default_rng([*seed, stream]) for stream in range(2))
        laser_in_base = profile.mounting(profile.laser.frame)
        self.profile = profile
        self.vehicle = Vehicle(engine, name, profile, from_pose2(base_in_world))
        self.section = Section(height=float(laser_in_base[2, 3]))
        self._engine = engine
        self.settings = settings
        self._drive = Drive(profile.drive, settings.command_timeout)
        self._dead_reckoning = DeadReckoning(profile.drive, settings, odometry_rng)
        self._lidar = Lidar(profile.laser, laser_in_base, settings, lidar_rng)
        self._touched: Set[str] = set()
        self._scan: Optional[Scan] = None

    @property
    def name(self) -> str:
        return self.vehicle.name

    def body(self) -> Body:
        """The robot as other robots see it."""
        vehicle = self.vehicle
        return Body(vehicle.base, vehicle.motion().pose, vehicle.collisions, mass=1.0)

    def command(self, twist: Twist2) -> None:
        """A new command; it holds until its time-out."""
        self._drive.command(twist)

    def halt(self) -> None:
        """Stands still at once, as if switched on anew."""
        self._drive.halt()

    def reset_odometry(self) -> None:
        self._dead_reckoning.reset()

    def begin_step(self) -> None:
        """Before a step of physics: sets the motors."""
        self.vehicle.drive(self._drive.wheel_speeds(1.0 / self.settings.physics_rate))

    def end_step(self, steps: int, stamp: float) -> None:
        """After the step of physics number ``steps``, at the time ``stamp``: feels and looks around."""
        self._touched.update(self.vehicle.touched())
        if steps % (self.settings.physics_rate // self.settings.scan_rate) == 0:
            self._scan = self._lidar.sweep(
                stamp,
                self.section.segments(self._engine.pose_of),
                self.section.retros(),
                to_pose2(self._engine.pose_of(self.vehicle.base)),
            )

    def observe(self, stamp: float) -> Observation:
        """What has been measured since the last call."""
        motion = self.vehicle.motion()
        twist = twist_in_base(motion)
        wheel_angles, wheel_speeds = self.vehicle.wheels()
        contacts, self._touched = tuple(sorted(self._touched)), set()
        scan, self._scan = self._scan, None
        return Observation(
            stamp=stamp,
            base_in_world=to_pose2(motion.pose),
            twist=twist,
            odometry=self._dead_reckoning.update(
                wheel_angles, twist.omega, 1.0 / self.settings.odometry_rate
            ),
            scan=scan,
            contacts=contacts,
            wheel_angles=wheel_angles,
            wheel_speeds=wheel_speeds,
            tilt=math.acos(min(motion.pose[2, 2], 1.0)),
        )

    def look_at(self, bodies: Iterable[Body]) -> None:
        """Adds bodies to what the laser can see."""
        for body in bodies:
            self.section.add(body)
