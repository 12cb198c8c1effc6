"""How a robot measures where it is: from its wheels and a gyro, with the errors both have, or truly."""

import math
from dataclasses import dataclass, field
from typing import Optional, Protocol, Tuple

import numpy as np

from planar import Pose2, Twist2
from sim_bridge.config import SimulationSettings
from sim_bridge.driving.drive import DriveProfile
from sim_bridge.sensors.base import Mounting, Schedule, SensorContext, every

STREAM = 0
# x, y and yaw are measured, the rest is not (kobuki_gazebo_plugins).
KOBUKI_VARIANCES = (0.1, 0.1, 1e6, 1e6, 1e6, 0.05)


@dataclass(frozen=True)
class Odometry:
    """Where the robot believes to be since its start, and how fast it believes to go."""

    base_in_odom: Pose2 = field(default_factory=Pose2)
    twist: Twist2 = field(default_factory=Twist2)


@dataclass(frozen=True)
class TrueMotion:
    """The truth after a period: where the robot is, how it moves, and its wheels' angles, left ones first."""

    base_in_world: Pose2
    twist: Twist2
    wheel_angles: Tuple[float, ...]
    seconds: float


class OdometryModel(Protocol):
    """Tells from how a robot moves where it believes to be."""

    def reset(self) -> None:
        """The odometry begins anew."""

    def update(self, moved: TrueMotion) -> Odometry:
        """Moves on by one period."""


@dataclass(frozen=True)
class OdometryProfile:
    """How a robot measures where it is.

    ``source``: ``gyro`` (distance from the wheels, heading from a gyro), ``encoder`` (both from the wheels)
    or ``world`` (the truth, in the frame of the world). ``rate`` in hertz, None for the simulation's.
    ``variances``, which are only told: of x, y, z, m^2, roll, pitch and yaw, rad^2.
    """

    source: str = "encoder"
    topic: str = "odom"
    frame: str = "odom"
    base_frame: str = "base_footprint"
    sends_transform: bool = True
    rate: Optional[float] = None
    variances: Tuple[float, ...] = KOBUKI_VARIANCES

    def odometry_model(self, drive: DriveProfile, mounting: Mounting) -> OdometryModel:
        """How the robot with this drive measures."""
        if self.source == "world":
            return TrueOdometry()
        return DeadReckoning(drive, self.source == "gyro", mounting.settings, mounting.rng(STREAM))


class Odometer:
    """Measures where the robot is, once a period."""

    name, on_demand = "odometry", False

    def __init__(self, profile: OdometryProfile, odometry_model: OdometryModel):
        self.frame = profile.frame
        self._reckoning = odometry_model
        self._seconds = 0.0

    def reset(self) -> None:
        self._reckoning.reset()

    def schedule(self, settings: SimulationSettings) -> Schedule:
        self._seconds = 1.0 / settings.odometry_rate
        return every(None, settings)

    def measure(self, context: SensorContext) -> Odometry:
        angles, _ = context.wheels
        return self._reckoning.update(TrueMotion(context.base.pose2, context.twist, angles, self._seconds))


class TrueOdometry:
    """The truth, in the frame of the world, as Gazebo's plugins tell it with the source ``world``."""

    def reset(self) -> None:
        """The frame of the world stays where it is."""

    def update(self, moved: TrueMotion) -> Odometry:
        return Odometry(moved.base_in_world, moved.twist)


class DeadReckoning:
    """Distance from the encoders, heading from the encoders too or, as Kobuki does, from a gyro.

    Encoder error: a scale for each side, drawn once; without a gyro one for both, as an unequal pair would
    only ever be used after calibration. Wheels slip: what they turn and what the robot travels differ by
    noise that grows with the root of the distance. Gyro error: scale and bias, drawn once, and white noise.
    Besides, the noise of odometry of Probabilistic Robotics (table 5.6), alpha 1 to 4.
    """

    def __init__(
        self, drive: DriveProfile, has_gyro: bool, settings: SimulationSettings, rng: np.random.Generator
    ):
        scales = 1.0 + rng.normal(0.0, settings.encoder_scale, 2)
        radii = drive.wheel_radius * (scales if has_gyro else scales[:1].repeat(2))
        self._radii: Tuple[float, ...] = tuple(radii.tolist())
        self._gyro_scale = 1.0 + rng.normal(0.0, settings.gyro_scale)
        self._gyro_bias = rng.normal(0.0, settings.gyro_bias)
        self._left_count = len(drive.left_joints)
        self._separation = drive.wheel_separation
        self._has_gyro = has_gyro
        self._settings = settings
        self._alphas = _MotionNoise(settings, rng)
        self._rng = rng
        self._angles = (0.0, 0.0)
        self._pose = Pose2()

    def reset(self) -> None:
        """The robot's present place becomes the origin of odometry."""
        self._pose = Pose2()

    def update(self, moved: TrueMotion) -> Odometry:
        """Moves on by one period."""
        left, right = moved.wheel_angles[: self._left_count], moved.wheel_angles[self._left_count :]
        sides = (sum(left) / len(left), sum(right) / len(right))
        rolled = tuple(
            (angle - before) * radius for angle, before, radius in zip(sides, self._angles, self._radii)
        )
        self._angles = sides
        distance = 0.5 * sum(rolled)
        slip = self._settings.wheel_slip * math.sqrt(abs(distance)) * self._rng.standard_normal()
        rate = self._measured_rate(moved, rolled)
        self._pose = self._pose @ self._alphas.disturbed(_arc(distance + slip, rate * moved.seconds))
        return Odometry(self._pose, Twist2(distance / moved.seconds, rate))

    def _measured_rate(self, moved: TrueMotion, rolled: Tuple[float, ...]) -> float:
        """The turn rate, rad/s, by the gyro or by the distances that the left and right side have rolled."""
        draw = self._rng.standard_normal()
        if self._has_gyro:
            noise = self._settings.gyro_noise / math.sqrt(moved.seconds) * draw
            return self._gyro_scale * moved.twist.omega + self._gyro_bias + noise
        left, right = rolled
        slip = self._settings.wheel_slip * math.sqrt(0.5 * (abs(left) + abs(right))) * draw
        return (right - left + slip) / self._separation / moved.seconds


class _MotionNoise:
    """Noise of heading and distance that grows with both, by the four alphas.

    Over a metre or a radian the variances are those of the table, of two metres twice that: so the noise does
    not depend on the length of the steps.
    """

    def __init__(self, settings: SimulationSettings, rng: np.random.Generator):
        self._alphas = (settings.alpha1, settings.alpha2, settings.alpha3, settings.alpha4)
        self._rng = rng

    def disturbed(self, step: Pose2) -> Pose2:
        """A motion of one period with noise added."""
        if not any(self._alphas):
            return step
        turn_by_turn, turn_by_way, way_by_way, way_by_turn = self._alphas
        distance, angle = math.hypot(step.x, step.y), abs(step.yaw)
        turn = math.sqrt(turn_by_turn * angle + turn_by_way * distance) * self._rng.standard_normal()
        way = math.sqrt(way_by_way * distance + way_by_turn * angle) * self._rng.standard_normal()
        return step @ Pose2(way, 0.0, turn)


def _arc(distance: float, angle: float) -> Pose2:
    """The pose reached along an arc from the origin."""
    if abs(angle) < 1e-9:
        return Pose2(distance, 0.0, angle)
    radius = distance / angle
    return Pose2(radius * math.sin(angle), radius * (1.0 - math.cos(angle)), angle)
