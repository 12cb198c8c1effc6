"""A robot in its scene: it is commanded, it moves, it measures."""

import math
from dataclasses import dataclass, replace
from typing import Callable, Dict, Iterable, Optional, Sequence, Tuple, Union

import numpy as np

from planar import Pose2, Scan, Twist2
from sim_bridge.config import SimulationSettings
from sim_bridge.description import LaserProfile, RobotProfile
from sim_bridge.driving.drive import Drive
from sim_bridge.geometry.pose3 import to_pose2
from sim_bridge.physics.engine import Contact, Engine
from sim_bridge.physics.vehicle import Vehicle, twist_in_base
from sim_bridge.sensors.kobuki import KobukiReading, KobukiSensors
from sim_bridge.sensors.lidar import Lidar
from sim_bridge.sensors.odometry import DeadReckoning, Moved, Odometry, TrueOdometry
from sim_bridge.views.section import Section
from sim_bridge.world import Body


@dataclass(frozen=True, eq=False)
class Observation:
    """What there is to know after a step.

    ``stamp``: simulated seconds since the start. ``base_in_world`` and ``twist`` are the truth, ``odometry``
    and ``scans`` (one of each range finder, None if none is due) what the robot measures. ``wheel_angles``,
    ``wheel_speeds``: of the driven wheels, those on the left first, rad and rad/s. ``contacts``: names
    (``model::link``) of what the robot has bumped into since the last step. ``tilt``: between the robot's
    axis and the vertical, rad. ``kobuki``: what a Kobuki base feels, None of other robots.
    """

    stamp: float
    base_in_world: Pose2
    twist: Twist2
    odometry: Odometry
    scans: Tuple[Optional[Scan], ...]
    contacts: Tuple[str, ...]
    wheel_angles: Tuple[float, ...]
    wheel_speeds: Tuple[float, ...]
    tilt: float
    kobuki: Optional[KobukiReading] = None

    @property
    def scan(self) -> Optional[Scan]:
        """Of the first range finder."""
        return self.scans[0] if self.scans else None


class Robot:
    """The robot ``name`` with its base at ``base_in_space``, (4, 4); ``seed``: of its sensors' noise."""

    def __init__(
        self,
        engine: Engine,
        name: str,
        profile: RobotProfile,
        base_in_space: np.ndarray,
        settings: SimulationSettings,
        seed: Sequence[int],
    ):
        odometry_rng, *laser_rngs = (
            np.random.default_rng([*seed, stream]) for stream in range(1 + len(profile.lasers))
        )
        self.profile = profile
        self.vehicle = Vehicle(engine, name, profile, base_in_space)
        self.settings = settings
        self._engine = engine
        self._drive = Drive(profile.drive)
        self._odometer = _odometer(profile, settings, odometry_rng)
        self._lookouts = [
            Lookout(laser, float(base_in_space[2, 3]), settings, rng)
            for laser, rng in zip(profile.lasers, laser_rngs)
        ]
        self._bumps: Dict[str, Contact] = {}
        self._kobuki = _kobuki_sensors(engine, profile)

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

    def switch_motors(self, on: bool) -> None:
        self._drive.switch(on)

    def reset_odometry(self) -> None:
        self._odometer.reset()

    def begin_step(self) -> None:
        """Before a step of physics: sets the motors."""
        self.vehicle.drive(*self._drive.wheel_speeds(1.0 / self.settings.physics_rate))

    def end_step(self, steps: int, stamp: float) -> None:
        """After the step of physics number ``steps``, at the time ``stamp``: feels and looks around."""
        self._bumps.update((bump.link, bump) for bump in self.vehicle.bumps())
        for lookout in self._lookouts:
            if lookout.is_due(steps, self.settings):
                lookout.look(stamp, self._engine.pose_of, self.vehicle.base)

    def observe(self, stamp: float) -> Observation:
        """What has been measured since the last call."""
        motion = self.vehicle.motion()
        base_in_world, twist = to_pose2(motion.pose), twist_in_base(motion)
        wheel_angles, wheel_speeds = self.vehicle.wheels()
        bumps, self._bumps = self._bumps, {}
        kobuki = None
        if self._kobuki is not None:
            kobuki = self._kobuki.read(motion.pose, [bump.point for bump in bumps.values()])
        moved = Moved(base_in_world, twist, wheel_angles, 1.0 / self.settings.odometry_rate)
        return Observation(
            stamp=stamp,
            base_in_world=base_in_world,
            twist=twist,
            odometry=self._odometer.update(moved),
            scans=tuple(lookout.take_scan() for lookout in self._lookouts),
            contacts=tuple(sorted(bumps)),
            wheel_angles=wheel_angles,
            wheel_speeds=wheel_speeds,
            tilt=math.acos(min(motion.pose[2, 2], 1.0)),
            kobuki=kobuki,
        )

    def look_at(self, bodies: Iterable[Body]) -> None:
        """Adds bodies to what the range finders can see."""
        for lookout in self._lookouts:
            for body in bodies:
                lookout.section.add(body)

    def lose_sight(self, link: str) -> None:
        """A link of the world is gone."""
        for lookout in self._lookouts:
            lookout.section.remove(link)

    def see_moved(self, link: str, pose: np.ndarray) -> None:
        """A link of the world has been put to another place, (4, 4)."""
        for lookout in self._lookouts:
            lookout.section.move(link, pose)


class Lookout:
    """A range finder, the level section of the world that it sees, and its latest scan."""

    def __init__(
        self, laser: LaserProfile, base_height: float, settings: SimulationSettings, rng: np.random.Generator
    ):
        self.section = Section(height=base_height + float(laser.pose_in_base[2, 3]))
        self._laser = laser
        noise = settings
        if laser.noise is not None and settings.range_noise > 0.0:  # else sensors are meant to be ideal
            noise = replace(settings, range_noise=laser.noise)
        self._lidar = Lidar(laser, noise, rng)
        self._scan: Optional[Scan] = None

    def is_due(self, steps: int, settings: SimulationSettings) -> bool:
        """Whether a scan ends with the step of physics number ``steps``."""
        rate = self._laser.rate or settings.scan_rate
        return steps % max(round(settings.physics_rate / rate), 1) == 0

    def look(self, stamp: float, pose_of: Callable[[str], np.ndarray], base: str) -> None:
        segments, retros = self.section.segments(pose_of), self.section.retros()
        self._scan = self._lidar.sweep(stamp, segments, retros, to_pose2(pose_of(base)))

    def take_scan(self) -> Optional[Scan]:
        """The scan since the last call, if any."""
        scan, self._scan = self._scan, None
        return scan


def _odometer(
    profile: RobotProfile, settings: SimulationSettings, rng: np.random.Generator
) -> Union[TrueOdometry, DeadReckoning]:
    if profile.odometry.source == "world":
        return TrueOdometry()
    return DeadReckoning(profile.drive, profile.odometry.source == "gyro", settings, rng)


def _kobuki_sensors(engine: Engine, profile: RobotProfile) -> Optional[KobukiSensors]:
    if profile.kobuki is None:
        return None
    hubs = np.array([profile.model.wheels[joint].origin_in_base[:3, 3] for joint in profile.drive.joints])
    return KobukiSensors(engine, profile.kobuki.cliff_threshold, hubs, profile.drive.wheel_radius)
