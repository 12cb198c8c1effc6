"""Settings of the keyboard teleop."""

import sys
from dataclasses import dataclass

from planar.config.config_file import Section
from planar.config.parameters import POSITIVE, check_parameters, parameter

_SPEED = POSITIVE._replace(high=sys.float_info.max)


@dataclass(frozen=True)
class TeleopSettings:
    """Initial full speed and turn rate."""

    scale_linear: float = parameter(0.2, "initial speed", "m/s", _SPEED)
    scale_angular: float = parameter(1.0, "initial turn rate", "rad/s", _SPEED)

    def __post_init__(self):
        check_parameters(self)


CONFIG_FILES = {
    "teleop_lite.yaml": Section(
        "", TeleopSettings, about="Every parameter of the keyboard teleop with its default."
    )
}
