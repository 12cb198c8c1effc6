"""Dead reckoning from wheel encoders and a gyro, with the errors both have."""

import math
from dataclasses import dataclass, field
from typing import Tuple

import numpy as np

from planar import Pose2, Twist2
from sim_bridge.config import SimulationSettings
from sim_bridge.robots import DriveProfile


@dataclass(frozen=True)
class Odometry:
    """Where the robot believes to be since its start, and how fast it believes to go."""

    base_in_odom: Pose2 = field(default_factory=Pose2)
    twist: Twist2 = field(default_factory=Twist2)


class DeadReckoning:
    """Distance from the encoders, heading from the gyro, as Kobuki does.

    Encoder error: a scale for each wheel, drawn once. Wheels slip: what they turn and what the robot travels
    differ by noise that grows with the root of the distance. Gyro error: scale and bias, drawn once, and
    white noise.
    """

    def __init__(self, drive: DriveProfile, settings: SimulationSettings, rng: np.random.Generator):
        self._radii = drive.wheel_radius * (1.0 + rng.normal(0.0, settings.encoder_scale, 2))
        self._gyro_scale = 1.0 + rng.normal(0.0, settings.gyro_scale)
        self._gyro_bias = rng.normal(0.0, settings.gyro_bias)
        self._settings = settings
        self._rng = rng
        self._angles = np.zeros(2)
        self._pose = Pose2()

    def reset(self) -> None:
        """The robot's present place becomes the origin of odometry."""
        self._pose = Pose2()

    def update(self, wheel_angles: Tuple[float, float], turn_rate: float, seconds: float) -> Odometry:
        """Moves on by ``seconds`` to ``wheel_angles``, rad; ``turn_rate``, rad/s, is the true one."""
        turned = np.asarray(wheel_angles) - self._angles
        self._angles = np.asarray(wheel_angles)
        distance = float((turned * self._radii).mean())
        slip = self._settings.wheel_slip * math.sqrt(abs(distance)) * self._rng.standard_normal()
        noise = self._settings.gyro_noise / math.sqrt(seconds) * self._rng.standard_normal()
        measured_rate = self._gyro_scale * turn_rate + self._gyro_bias + noise
        self._pose = self._pose @ _arc(distance + slip, measured_rate * seconds)
        return Odometry(self._pose, Twist2(distance / seconds, measured_rate))


def _arc(distance: float, angle: float) -> Pose2:
    """The pose reached along an arc from the origin."""
    if abs(angle) < 1e-9:
        return Pose2(distance, 0.0, angle)
    radius = distance / angle
    return Pose2(radius * math.sin(angle), radius * (1.0 - math.cos(angle)), angle)
