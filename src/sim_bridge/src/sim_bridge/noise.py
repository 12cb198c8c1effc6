"""How wrong a robot's sensors are, as named data."""

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
    """Standard deviations, but for two shares and four variances (Probabilistic Robotics, table 5.6)."""

    range_noise: float = _error(0.01, "standard deviation of a laser range", "m")
    range_dropouts: float = _error(0.0, "share of the laser's beams that measure nothing")
    range_max_readings: float = _error(0.0, "share of the laser's beams that read the greatest range")
    encoder_scale: float = _error(
        0.02, "standard deviation of the relative error of each wheel's radius, drawn once a run"
    )
    wheel_slip: float = _error(
        0.01, "standard deviation of the distance measured over 1 m; grows with the root of the distance", "m"
    )
    gyro_scale: float = _error(0.01, "standard deviation of the gyro's relative error, drawn once a run")
    gyro_bias: float = _error(0.001, "standard deviation of the gyro's bias, drawn once a run", "rad/s")
    gyro_noise: float = _error(0.0005, "density of the gyro's white noise", "rad/sqrt(s)")
    alpha1: float = _error(0.0, "variance of odometry's heading for each rad turned", "rad^2")
    alpha2: float = _error(0.0, "variance of odometry's heading for each m driven", "rad^2")
    alpha3: float = _error(0.0, "variance of odometry's distance for each m driven", "m^2")
    alpha4: float = _error(0.0, "variance of odometry's distance for each rad turned", "m^2")
    acceleration_noise: float = _error(
        0.02, "standard deviation of an acceleration measured by the IMU", "m/s^2"
    )
    colour_noise: float = _error(0.007, "standard deviation of a camera's colours, 0 to 1")
    depth_noise: float = _error(
        0.002, "standard deviation of a depth of 1 m; grows with the square of the depth", "m"
    )

    def __post_init__(self):
        check_parameters(self)
        shares = self.range_dropouts + self.range_max_readings
        check(shares <= 1.0, "range_dropouts", "with range_max_readings at most 1", shares)


# ``turtlebot``: a Kobuki with a Kinect or a small lidar; ``bad``: what a localization should still bear.
NOISE_PROFILES: Dict[str, NoiseSettings] = {
    "ideal": NoiseSettings(**{field.name: 0.0 for field in fields(NoiseSettings)}),
    "turtlebot": NoiseSettings(),
    "bad": NoiseSettings(
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


def noise_named(name: str) -> Dict[str, Any]:
    """The values of a noise profile by their names. Raises SettingsError."""
    if name not in NOISE_PROFILES:
        raise SettingsError(
            f"noise must be one of {', '.join(NOISE_PROFILES)}, got {name!r}{hint(name, NOISE_PROFILES)}"
        )
    return asdict(NOISE_PROFILES[name])
