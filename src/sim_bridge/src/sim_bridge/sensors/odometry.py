"""Odometry: dead reckoning from wheels and gyro, with their errors, or the true pose."""

import math
from dataclasses import dataclass, field
from typing import Optional, Protocol, Tuple

import numpy as np

from planar import Pose2, Twist2
from sim_bridge.config import SimulationSettings
from sim_bridge.driving.drive import REST_SECONDS, DriveProfile
from sim_bridge.sensors.base import Mounting, Schedule, SensorContext, every

STREAM = 0
# Variances of x, y, z [m^2], roll, pitch and yaw [rad^2]; large ones are not measured
# (kobuki_gazebo_plugins).
KOBUKI_VARIANCES = (0.1, 0.1, 1e6, 1e6, 1e6, 0.05)
# Speed of a wheel [rad/s] below which it stands: a tick a second of a Kobuki's encoders, which have 2578.33 a
# revolution.
MAX_REST_SPEED = 2.0 * math.pi / 2578.33
# Turn rate [rad/s], above the noise of the gyro, above which a base turns although its wheels stand.
MAX_REST_RATE = 0.1


@dataclass(frozen=True)
class Odometry:
    """An odometry estimate.

    Attributes:
        base_in_odom: Pose of the base in the odometry frame.
        twist: Velocity in the base frame.
    """

    base_in_odom: Pose2 = field(default_factory=Pose2)
    twist: Twist2 = field(default_factory=Twist2)


@dataclass(frozen=True)
class TrueMotion:
    """True motion of a robot in one period.

    Attributes:
        base_in_world: Pose of the base at the end of the period.
        twist: Velocity at the end, in the base frame.
        wheel_angles: Angles of the driven wheels at the end, those on the left first [rad].
        seconds: Length of the period [s].
    """

    base_in_world: Pose2
    twist: Twist2
    wheel_angles: Tuple[float, ...]
    seconds: float


class OdometryModel(Protocol):
    """Estimates the pose of a robot from its motion."""

    def reset(self) -> None:
        """Reset the pose to the origin."""

    def update(self, motion: TrueMotion) -> Odometry:
        """Integrate the motion of one period, and return the estimate.

        Args:
            motion: True motion, to which the model adds its errors.
        """


@dataclass(frozen=True)
class OdometryProfile:
    """Settings of a robot's odometry.

    Attributes:
        source: ``gyro`` (distance from the wheels, heading from a gyro), ``encoder`` (both from the wheels)
            or ``world`` (the true pose in the world).
        topic: Topic of its messages.
        frame: Parent frame.
        base_frame: Child frame.
        sends_transform: Whether the transform between them is published on /tf.
        rate: Rate of the messages [Hz]; None for that of the simulation.
        variances: Published variances of x, y, z [m^2], roll, pitch and yaw [rad^2].
    """

    source: str = "encoder"
    topic: str = "odom"
    frame: str = "odom"
    base_frame: str = "base_footprint"
    sends_transform: bool = True
    rate: Optional[float] = None
    variances: Tuple[float, ...] = KOBUKI_VARIANCES

    def build(self, drive: DriveProfile, mounting: Mounting) -> OdometryModel:
        """Make the odometry model of a robot.

        Args:
            drive: Geometry of the wheels.
            mounting: Start pose, noise and seed.
        """
        if self.source == "world":
            return TrueOdometry()
        return DeadReckoning(drive, self.source == "gyro", mounting.settings, mounting.rng(STREAM))


class Odometer:
    """The odometry sensor of a robot, which measures in each odometry period.

    Args:
        profile: Frames and source.
        model: Estimates the pose.
    """

    name, on_demand = "odometry", False

    def __init__(self, profile: OdometryProfile, model: OdometryModel):
        self.frame = profile.frame
        self._model = model
        self._seconds = 0.0
        self._latest, self._is_held = Odometry(), False

    def reset(self) -> None:
        self._model.reset()
        self._latest = Odometry()

    def hold(self, is_held: bool) -> None:
        """Measure the last pose, at rest, without integrating, or integrate again."""
        self._is_held = is_held

    def schedule(self, settings: SimulationSettings) -> Schedule:
        self._seconds = 1.0 / settings.odometry_rate
        return every(None, settings)

    def measure(self, context: SensorContext) -> Odometry:
        if self._is_held:
            return Odometry(self._latest.base_in_odom)
        angles, _ = context.wheels
        motion = TrueMotion(context.base.pose2, context.twist, angles, self._seconds)
        self._latest = self._model.update(motion)
        return self._latest


class TrueOdometry:
    """Odometry without drift: the true pose in the world, as Gazebo's plugins with the source ``world``."""

    def reset(self) -> None:
        """Do nothing: the world frame is fixed."""

    def update(self, motion: TrueMotion) -> Odometry:
        return Odometry(motion.base_in_world, motion.twist)


class DeadReckoning:
    """Dead reckoning: distance from the encoders, heading from them or, as on a Kobuki, from a gyro.

    Errors are those of:

    * the encoders: a scale for each side, drawn once; without a gyro one for both sides, because an
      uncalibrated pair would not be used;
    * wheel slip: noise of the distance that grows with its square root;
    * the gyro: scale and bias, drawn once, and white noise;
    * the odometry motion model (Probabilistic Robotics, table 5.6): alpha1 to alpha4.

    While the wheels stand, the pose is held, so that the gyro's bias does not turn it.

    Args:
        drive: Geometry of the wheels.
        has_gyro: Whether the heading is from a gyro.
        settings: Noise.
        rng: Random generator.
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
        self._motion_noise = _MotionNoise(settings, rng)
        self._rng = rng
        self._angles = (0.0, 0.0)
        self._rest_seconds = 0.0
        self._pose = Pose2()

    def reset(self) -> None:
        """Make the present pose the origin of the odometry frame."""
        self._pose = Pose2()

    def update(self, motion: TrueMotion) -> Odometry:
        """Integrate the motion of one period, and return the estimate."""
        left, right = motion.wheel_angles[: self._left_count], motion.wheel_angles[self._left_count :]
        sides = (sum(left) / len(left), sum(right) / len(right))
        is_at_rest = self._is_at_rest(sides, motion.seconds)
        rolled = tuple(
            (angle - before) * radius for angle, before, radius in zip(sides, self._angles, self._radii)
        )
        self._angles = sides
        distance = 0.5 * sum(rolled)
        slip = self._settings.wheel_slip * math.sqrt(abs(distance)) * self._rng.standard_normal()
        rate = self._measured_rate(motion, rolled)
        if is_at_rest and abs(rate) < MAX_REST_RATE:
            return Odometry(self._pose)
        self._pose = self._pose @ self._motion_noise.apply(_arc(distance + slip, rate * motion.seconds))
        return Odometry(self._pose, Twist2(distance / motion.seconds, rate))

    def _is_at_rest(self, sides: Tuple[float, float], seconds: float) -> bool:
        """Return whether the wheels, now at the angles ``sides`` [rad], have stood for REST_SECONDS."""
        fastest = max(abs(angle - before) for angle, before in zip(sides, self._angles)) / seconds
        self._rest_seconds = self._rest_seconds + seconds if fastest < MAX_REST_SPEED else 0.0
        return self._rest_seconds >= REST_SECONDS

    def _measured_rate(self, motion: TrueMotion, rolled: Tuple[float, ...]) -> float:
        """Return the turn rate [rad/s] from the gyro, or from the rolled distances (left, right) [m]."""
        draw = self._rng.standard_normal()
        if self._has_gyro:
            noise = self._settings.gyro_noise / math.sqrt(motion.seconds) * draw
            return self._gyro_scale * motion.twist.omega + self._gyro_bias + noise
        left, right = rolled
        slip = self._settings.wheel_slip * math.sqrt(0.5 * (abs(left) + abs(right))) * draw
        return (right - left + slip) / self._separation / motion.seconds


class _MotionNoise:
    """Noise of heading and distance by alpha 1 to 4 (Probabilistic Robotics, table 5.6).

    Variances are proportional to distance and angle, unlike the table's, so that they do not depend on the
    period.
    """

    def __init__(self, settings: SimulationSettings, rng: np.random.Generator):
        self._alphas = (settings.alpha1, settings.alpha2, settings.alpha3, settings.alpha4)
        self._rng = rng

    def apply(self, step: Pose2) -> Pose2:
        """Return the motion of one period with noise."""
        if not any(self._alphas):
            return step
        alpha1, alpha2, alpha3, alpha4 = self._alphas
        distance, angle = math.hypot(step.x, step.y), abs(step.yaw)
        turn = math.sqrt(alpha1 * angle + alpha2 * distance) * self._rng.standard_normal()
        advance = math.sqrt(alpha3 * distance + alpha4 * angle) * self._rng.standard_normal()
        return step @ Pose2(advance, 0.0, turn)


def _arc(distance: float, angle: float) -> Pose2:
    """Return the pose at the end of an arc from the origin."""
    if abs(angle) < 1e-9:
        return Pose2(distance, 0.0, angle)
    radius = distance / angle
    return Pose2(radius * math.sin(angle), radius * (1.0 - math.cos(angle)), angle)
