"""Settings of the marker."""

from dataclasses import dataclass

from planar.config.settings import check

MODES = ("service", "mission", "demo")
SOURCES = ("tf", "amcl_pose", "odom", "state")


@dataclass(frozen=True)
class MarkerSettings:
    """Which story the marker tells, and what tells it where the robot is. Seconds are simulated."""

    zones_file: str = ""
    mode: str = "service"
    pose_source: str = "tf"
    show_seconds: float = 5.0
    hide_seconds: float = 5.0
    pickup_seconds: float = 5.0
    frame_id: str = "map"
    base_frame_id: str = "base_footprint"
    size: float = 0.2
    robot_model: str = "mobile_base"

    def __post_init__(self):
        check(bool(self.zones_file), "zones_file", "the path of a YAML file of zones", self.zones_file)
        check(self.mode in MODES, "mode", f"one of {', '.join(MODES)}", self.mode)
        check(self.pose_source in SOURCES, "pose_source", f"one of {', '.join(SOURCES)}", self.pose_source)
        check(self.show_seconds >= 0.0, "show_seconds", "zero or more", self.show_seconds)
        check(self.hide_seconds >= 0.0, "hide_seconds", "zero or more", self.hide_seconds)
        check(self.pickup_seconds >= 0.0, "pickup_seconds", "zero or more", self.pickup_seconds)
        check(self.size > 0.0, "size", "positive", self.size)
