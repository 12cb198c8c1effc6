"""Noise of a robot's sensors: the parameters, and named profiles of them."""

import warnings
from dataclasses import asdict, dataclass, fields
from typing import Any, Dict

from planar import SettingsError
from planar.config.hints import hint
from planar.config.parameters import Interval, check_parameters, parameter
from planar.config.settings import check

NOT_NEGATIVE = Interval(0.0, words="not negative")


def _error(default: float, meaning: str, unit: str = "") -> Any:
    return parameter(default, meaning, unit, NOT_NEGATIVE)


@dataclass(frozen=True)
class NoiseSettings:
    """Noise of the sensors; ``alpha1`` to ``alpha4`` as in Probabilistic Robotics, table 5.6."""

    range_noise: float = _error(0.01, "standard deviation of a laser range", "m")
    range_dropouts: float = _error(0.0, "fraction of the laser's beams without a return")
    range_max_readings: float = _error(0.0, "fraction of the laser's beams that read the maximum range")
    encoder_scale: float = _error(
        0.02, "standard deviation of each wheel radius's relative error, drawn once per run"
    )
    wheel_slip: float = _error(
        0.01,
        "standard deviation of the measured distance after 1 m; grows with the square root of the distance",
        "m",
    )
    gyro_scale: float = _error(0.01, "standard deviation of the gyro's scale error, drawn once per run")
    gyro_bias: float = _error(0.001, "standard deviation of the gyro's bias, drawn once per run", "rad/s")
    gyro_noise: float = _error(0.0005, "noise density of the gyro (angle random walk)", "rad/sqrt(s)")
    alpha1: float = _error(0.0, "variance of the odometry's heading per rad of rotation", "rad^2")
    alpha2: float = _error(0.0, "variance of the odometry's heading per metre", "rad^2")
    alpha3: float = _error(0.0, "variance of the odometry's distance per metre", "m^2")
    alpha4: float = _error(0.0, "variance of the odometry's distance per rad of rotation", "m^2")
    acceleration_noise: float = _error(0.02, "standard deviation of the IMU's acceleration", "m/s^2")
    colour_noise: float = _error(0.007, "standard deviation of a camera's colours (0 to 1)")
    depth_noise: float = _error(
        0.002, "standard deviation of a depth of 1 m; grows with the square of the depth", "m"
    )

    def __post_init__(self):
        check_parameters(self)
        fractions = self.range_dropouts + self.range_max_readings
        check(fractions <= 1.0, "range_dropouts", "with range_max_readings at most 1", fractions)


# ``turtlebot``: a Kobuki with a Kinect or a small lidar; ``high``: the most that localization has to handle.
NOISE_PROFILES: Dict[str, NoiseSettings] = {
    "ideal": NoiseSettings(**{field.name: 0.0 for field in fields(NoiseSettings)}),
    "turtlebot": NoiseSettings(),
    "high": NoiseSettings(
        range_noise=0.03,
        range_dropouts=0.02,
        range_max_readings=0.01,
        encoder_scale=0.06,
        wheel_slip=0.03,
        gyro_scale=0.03,
        gyro_bias=0.005,
        gyro_noise=0.002,
        acceleration_noise=0.1,
        colour_noise=0.03,
        depth_noise=0.006,
    ),
}

DEPRECATED_PROFILES = {"bad": "high"}


def noise_named(name: str) -> Dict[str, Any]:
    """Return the values of a noise profile by parameter.

    Args:
        name: One of NOISE_PROFILES, or the deprecated ``bad`` for ``high``.

    Raises:
        SettingsError: There is no such profile.
    """
    if name in DEPRECATED_PROFILES:
        new = DEPRECATED_PROFILES[name]
        warnings.warn(f"the noise profile {name!r} is deprecated; use {new!r}", FutureWarning, stacklevel=2)
        name = new
    if name not in NOISE_PROFILES:
        raise SettingsError(
            f"noise must be one of {', '.join(NOISE_PROFILES)}, got {name!r}{hint(name, NOISE_PROFILES)}"
        )
    return asdict(NOISE_PROFILES[name])
