"""How wrong a robot's sensors are, as named data."""

from dataclasses import asdict, dataclass, fields
from typing import Any, Dict

from planar import SettingsError
from planar.config.hints import hint
from planar.config.settings import check


@dataclass(frozen=True)
class NoiseSettings:
    """Standard deviations, but for two shares and four variances.

    ``range_noise``: of a laser's range, m; ``range_dropouts``, ``range_max_readings``: the shares of beams
    that measure nothing, and that read the greatest range, whatever there is.
    ``encoder_scale``, ``gyro_scale`` and ``gyro_bias`` (rad/s): of the relative error of each wheel's radius,
    and of the gyro's errors, all drawn once a run. ``wheel_slip``: of the distance measured over 1 m, m;
    grows with the root of the distance. ``gyro_noise``: density of the white noise, rad/sqrt(s).
    ``alpha1`` to ``alpha4``: variances of odometry's heading, rad^2, for each rad turned and m driven, and of
    its distance, m^2, for each m driven and rad turned (Probabilistic Robotics, table 5.6).
    ``acceleration_noise``: of the IMU, m/s^2; ``colour_noise``: of a camera, 0 to 1; ``depth_noise``: of a
    depth camera at 1 m, m, growing with the square of the depth.
    """

    range_noise: float = 0.01
    range_dropouts: float = 0.0
    range_max_readings: float = 0.0
    encoder_scale: float = 0.02
    wheel_slip: float = 0.01
    gyro_scale: float = 0.01
    gyro_bias: float = 0.001
    gyro_noise: float = 0.0005
    alpha1: float = 0.0
    alpha2: float = 0.0
    alpha3: float = 0.0
    alpha4: float = 0.0
    acceleration_noise: float = 0.02
    colour_noise: float = 0.007
    depth_noise: float = 0.002

    def __post_init__(self):
        for field in fields(NoiseSettings):
            value = getattr(self, field.name)
            check(value >= 0.0, field.name, "not negative", value)
        shares = self.range_dropouts + self.range_max_readings
        check(shares <= 1.0, "range_dropouts", "with range_max_readings at most 1", shares)


# ``turtlebot``: a Kobuki with a Kinect or a small lidar; ``bad``: what a localization should still bear.
NOISES: Dict[str, NoiseSettings] = {
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
    if name not in NOISES:
        raise SettingsError(f"noise must be one of {', '.join(NOISES)}, got {name!r}{hint(name, NOISES)}")
    return asdict(NOISES[name])
