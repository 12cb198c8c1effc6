"""Inertial measurement unit (REP 145)."""

import math
from dataclasses import dataclass
from typing import Optional, Tuple

import numpy as np

from planar.config.settings import check
from sim_bridge.config import SimulationSettings
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.sdf.values import number, text
from sim_bridge.sensors.base import Mounting, Schedule, SensorContext, every
from sim_bridge.sensors.element import SensorElement

STREAM = 200


@dataclass(frozen=True)
class ImuSettings:
    """Errors of an IMU, the same for each axis.

    Attributes:
        gyro_noise: Standard deviation of the angular velocity [rad/s].
        gyro_bias: Standard deviation of its constant bias, drawn once [rad/s].
        acceleration_noise: Standard deviation of the linear acceleration [m/s^2].
    """

    gyro_noise: float = 0.0
    gyro_bias: float = 0.0
    acceleration_noise: float = 0.0

    def __post_init__(self):
        for name in ("gyro_noise", "gyro_bias", "acceleration_noise"):
            check(getattr(self, name) >= 0.0, name, "not negative", getattr(self, name))


@dataclass(frozen=True, eq=False)
class ImuReading:
    """Measurement of an IMU.

    Attributes:
        orientation: Orientation of the sensor in the world, as a pose (4, 4) without position.
        angular_velocity: Angular velocity (3,) along the sensor's axes [rad/s].
        acceleration: Acceleration (3,) along the sensor's axes [m/s^2]; +g upwards at rest (REP 145).
    """

    orientation: np.ndarray
    angular_velocity: np.ndarray
    acceleration: np.ndarray


@dataclass(frozen=True, eq=False)
class ImuProfile:
    """Settings of an IMU.

    Attributes:
        topic: Topic of its messages.
        frame: Frame of its measurements.
        pose_in_base: Pose (4, 4) in the base frame.
        rate: Rate of the messages [Hz]; None for that of odometry.
        noise: Standard deviation of all measurements [rad/s and m/s^2]; None for that of the simulation.
        orientation_variances: Published variances (3,) about the sensor's axes [rad^2]; 0 is unknown
            (sensor_msgs/Imu).
        angular_velocity_variances: Published variances (3,) of the angular velocity [rad^2/s^2].
        acceleration_variances: Published variances (3,) of the acceleration [m^2/s^4].
    """

    topic: str
    frame: str
    pose_in_base: np.ndarray
    rate: Optional[float] = None
    noise: Optional[float] = None
    orientation_variances: Tuple[float, ...] = (0.0, 0.0, 0.0)
    angular_velocity_variances: Tuple[float, ...] = (0.0, 0.0, 0.0)
    acceleration_variances: Tuple[float, ...] = (0.0, 0.0, 0.0)

    def build(self, mounting: Mounting) -> "Imu":
        """Make the sensor; the standard deviation of its white noise grows with the root of the rate."""
        settings = mounting.settings
        rate = self.rate or settings.odometry_rate
        gyro_noise, acceleration_noise = settings.gyro_noise * math.sqrt(rate), settings.acceleration_noise
        if self.noise is not None and gyro_noise > 0.0:  # 0: an ideal simulation has no noise
            gyro_noise = acceleration_noise = self.noise
        errors = ImuSettings(gyro_noise, settings.gyro_bias, acceleration_noise)
        return Imu(errors, mounting.rng(STREAM), self)


class Imu:
    """Measures angular velocity, and acceleration as the change of velocity between two readings.

    Args:
        settings: Standard deviations of the errors.
        rng: Random generator of the errors.
        profile: Frame, pose, rate and topic.
    """

    on_demand = True

    def __init__(self, settings: ImuSettings, rng: np.random.Generator, profile: ImuProfile):
        self.name, self.frame = profile.topic, profile.frame
        self._profile = profile
        self._seconds = 0.0
        self._settings = settings
        self._rng = rng
        self._bias = rng.normal(0.0, settings.gyro_bias, 3)
        self._velocity: Optional[np.ndarray] = None

    def schedule(self, settings: SimulationSettings) -> Schedule:
        schedule = every(self._profile.rate, settings)
        self._seconds = schedule.interval / settings.physics_rate
        return schedule

    def measure(self, context: SensorContext) -> ImuReading:
        sensor = context.base.of_frame(self._profile.pose_in_base)
        return self.read(sensor, self._seconds, context.gravity)

    def read(self, sensor: KinematicState, seconds: float, gravity: float) -> ImuReading:
        """Return a measurement with errors.

        Args:
            sensor: Pose and velocity of the sensor in the world.
            seconds: Time since the last reading [s].
            gravity: Downward acceleration [m/s^2].
        """
        before = sensor.linear if self._velocity is None else self._velocity
        self._velocity = sensor.linear
        proper_acceleration = (sensor.linear - before) / seconds + (0.0, 0.0, gravity)
        to_sensor = sensor.pose[:3, :3].T
        orientation = np.eye(4)
        orientation[:3, :3] = sensor.pose[:3, :3]
        return ImuReading(
            orientation,
            to_sensor @ sensor.angular + self._bias + self._noise(self._settings.gyro_noise),
            to_sensor @ proper_acceleration + self._noise(self._settings.acceleration_noise),
        )

    def _noise(self, deviation: float) -> np.ndarray:
        return self._rng.normal(0.0, deviation, 3)


def read_imu(element: SensorElement) -> ImuProfile:
    """Read an IMU of Gazebo (gazebo_ros_imu or hector_gazebo_ros_imu), in a <sensor> or below the model.

    Raises:
        WorldError: A value is not valid.
    """
    plugin = element.plugin
    noise = plugin.child("gaussianNoise")
    deviation = noise.numbers(1)[0] if noise is not None else None
    variances = ((deviation or 0.0) ** 2,) * 3
    return ImuProfile(
        topic=text(plugin, "topicName", "imu"),
        frame=text(plugin, "frameName", "") or text(plugin, "frameId", "") or element.link,
        pose_in_base=element.pose_in_base,
        rate=number(plugin, "updateRateHZ", 0.0) or number(plugin, "updateRate", 0.0) or None,
        noise=deviation,
        orientation_variances=variances,
        angular_velocity_variances=variances,
        acceleration_variances=variances,
    )
