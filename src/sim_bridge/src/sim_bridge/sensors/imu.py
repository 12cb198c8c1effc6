"""An inertial measurement unit."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from planar.config.settings import check
from sim_bridge.physics.engine import Motion


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
    turn_rates: np.ndarray
    acceleration: np.ndarray


class Imu:
    """Feels how it turns and how its velocity changes from one reading to the next."""

    def __init__(self, settings: ImuSettings, rng: np.random.Generator):
        self._settings = settings
        self._rng = rng
        self._bias = rng.normal(0.0, settings.turn_bias, 3)
        self._velocity: Optional[np.ndarray] = None

    def measure(self, sensor: Motion, seconds: float, gravity: float) -> ImuReading:
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
