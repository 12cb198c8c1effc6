"""Settings of the keyboard teleop."""

from dataclasses import dataclass

from planar.config.settings import check


@dataclass(frozen=True)
class TeleopSettings:
    """Speeds that full forward and full left mean at the start: m/s and rad/s."""

    scale_linear: float = 0.2
    scale_angular: float = 1.0

    def __post_init__(self):
        for name in ("scale_linear", "scale_angular"):
            value = getattr(self, name)
            check(0.0 < value < float("inf"), name, "positive", value)
