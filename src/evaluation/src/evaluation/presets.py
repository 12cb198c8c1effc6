"""Parameter files of the robot that runs are evaluated with."""

from pathlib import Path

PACKAGES = Path(__file__).resolve().parents[3]
LOCALIZATION_CONFIG = PACKAGES / "amcl_lite/config/turtlebot.yaml"
NAVIGATION_CONFIG = PACKAGES / "move_base_lite/config/turtlebot.yaml"
