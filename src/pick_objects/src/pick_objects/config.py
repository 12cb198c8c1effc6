"""Settings of the errand."""

from dataclasses import dataclass

from planar.settings import check


@dataclass(frozen=True)
class ErrandSettings:
    """How patient the errand is. Seconds are simulated seconds."""

    pickup_seconds: float = 5.0
    goal_timeout: float = 180.0
    attempts: int = 3
    retry_seconds: float = 1.0

    def __post_init__(self):
        check(self.pickup_seconds >= 0.0, "pickup_seconds", "zero or more", self.pickup_seconds)
        check(self.goal_timeout > 0.0, "goal_timeout", "positive", self.goal_timeout)
        check(self.attempts >= 1, "attempts", "at least 1", self.attempts)
        check(self.retry_seconds >= 0.0, "retry_seconds", "zero or more", self.retry_seconds)


@dataclass(frozen=True)
class NodeSettings:
    """Where the node finds what it needs. Waits for others are counted in wall-clock seconds."""

    zones_file: str = ""
    frame_id: str = "map"
    server_timeout: float = 60.0
    map_timeout: float = 10.0

    def __post_init__(self):
        check(bool(self.zones_file), "zones_file", "the path of a YAML file of zones", self.zones_file)
        check(self.server_timeout > 0.0, "server_timeout", "positive", self.server_timeout)
        check(self.map_timeout > 0.0, "map_timeout", "positive", self.map_timeout)
