"""An inertial measurement unit."""

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
    """Standard deviations, of each axis: ``turn_noise``, rad/s, ``acceleration_noise``, m/s^2.

    ``turn_bias``: of what each turn rate is wrong by all the time, rad/s.
    """

    turn_noise: float = 0.0
    turn_bias: float = 0.0
    acceleration_noise: float = 0.0

    def __post_init__(self):
        for name in ("turn_noise", "turn_bias", "acceleration_noise"):
            check(getattr(self, name) >= 0.0, name, "not negative", getattr(self, name))


@dataclass(frozen=True, eq=False)
class ImuReading:
    """``orientation``: (4, 4), of the sensor in the world; ``turn_rates`` (3,), rad/s, along its axes.

    ``acceleration``: (3,), m/s^2, along its axes. A sensor at rest feels the acceleration that keeps it from
    falling: +g upwards (REP 145).
    """

    orientation: np.ndarray
    angular_velocity: np.ndarray
    acceleration: np.ndarray


@dataclass(frozen=True, eq=False)
class ImuProfile:
    """An inertial sensor at ``pose_in_base`` (4, 4).

    ``rate`` in hertz and ``noise``, the standard deviation of what it measures in SI units, are None where
    the simulation's settings decide. Variances, (3,) each, about and along its axes, are only told; 0 means
    unknown (sensor_msgs/Imu).
    """

    topic: str
    frame: str
    pose_in_base: np.ndarray
    rate: Optional[float] = None
    noise: Optional[float] = None
    orientation_variances: Tuple[float, ...] = (0.0, 0.0, 0.0)
    turn_variances: Tuple[float, ...] = (0.0, 0.0, 0.0)
    acceleration_variances: Tuple[float, ...] = (0.0, 0.0, 0.0)

    def build(self, mounting: Mounting) -> "Imu":
        """White noise of the turn rate is stronger the shorter it is looked at."""
        settings = mounting.settings
        rate = self.rate or settings.odometry_rate
        turn_noise, acceleration_noise = settings.gyro_noise * math.sqrt(rate), settings.acceleration_noise
        if self.noise is not None and turn_noise > 0.0:  # else sensors are meant to be ideal
            turn_noise = acceleration_noise = self.noise
        errors = ImuSettings(turn_noise, settings.gyro_bias, acceleration_noise)
        return Imu(errors, mounting.rng(STREAM), self)


class Imu:
    """Feels how it turns and how its velocity changes from one reading to the next."""

    on_demand = True

    def __init__(self, settings: ImuSettings, rng: np.random.Generator, profile: ImuProfile):
        self.name, self.frame = profile.topic, profile.frame
        self._profile = profile
        self._seconds = 0.0
        self._settings = settings
        self._rng = rng
        self._bias = rng.normal(0.0, settings.turn_bias, 3)
        self._velocity: Optional[np.ndarray] = None

    def schedule(self, settings: SimulationSettings) -> Schedule:
        schedule = every(self._profile.rate, settings)
        self._seconds = schedule.interval / settings.physics_rate
        return schedule

    def measure(self, context: SensorContext) -> ImuReading:
        sensor = context.base.of_frame(self._profile.pose_in_base)
        return self.feel(sensor, self._seconds, context.gravity)

    def feel(self, sensor: KinematicState, seconds: float, gravity: float) -> ImuReading:
        """``sensor``: its motion in the world; ``seconds`` since the last reading; ``gravity``: downwards."""
        before = sensor.linear if self._velocity is None else self._velocity
        self._velocity = sensor.linear
        felt = (sensor.linear - before) / seconds + (0.0, 0.0, gravity)
        to_sensor = sensor.pose[:3, :3].T
        orientation = np.eye(4)
        orientation[:3, :3] = sensor.pose[:3, :3]
        return ImuReading(
            orientation,
            to_sensor @ sensor.angular + self._bias + self._noise(self._settings.turn_noise),
            to_sensor @ felt + self._noise(self._settings.acceleration_noise),
        )

    def _noise(self, deviation: float) -> np.ndarray:
        return self._rng.normal(0.0, deviation, 3)


def read_imu(found: SensorElement) -> ImuProfile:
    """Of gazebo_ros_imu and its like, in a <sensor> or below the model. Raises WorldError."""
    plugin = found.plugin
    noise = plugin.child("gaussianNoise")
    deviation = noise.numbers(1)[0] if noise is not None else None
    variances = ((deviation or 0.0) ** 2,) * 3
    return ImuProfile(
        topic=text(plugin, "topicName", "imu"),
        frame=text(plugin, "frameName", "") or text(plugin, "frameId", "") or found.link,
        pose_in_base=found.pose_in_base,
        rate=number(plugin, "updateRateHZ", 0.0) or number(plugin, "updateRate", 0.0) or None,
        noise=deviation,
        orientation_variances=variances,
        turn_variances=variances,
        acceleration_variances=variances,
    )
