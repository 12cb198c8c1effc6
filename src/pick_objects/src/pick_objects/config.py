"""Settings of the errand and of its node."""

from dataclasses import dataclass

from planar.config.settings import check

FAILURE_POLICIES = ("stop", "continue")
ORDERS = ("given", "shortest")


@dataclass(frozen=True)
class ErrandSettings:
    """How long things take, how patient the robot is, and what it makes of failures. Simulated seconds.

    ``attempts``: how often a place is tried; each attempt goes to the next of its poses.
    ``on_failure``: whether a delivery that fails ends the mission. ``order``: of the deliveries.
    """

    pickup_seconds: float = 5.0
    dropoff_seconds: float = 0.0
    goal_timeout: float = 180.0
    attempts: int = 3
    retry_seconds: float = 1.0
    on_failure: str = "stop"
    order: str = "given"

    def __post_init__(self):
        check(self.pickup_seconds >= 0.0, "pickup_seconds", "zero or more", self.pickup_seconds)
        check(self.dropoff_seconds >= 0.0, "dropoff_seconds", "zero or more", self.dropoff_seconds)
        check(self.goal_timeout > 0.0, "goal_timeout", "positive", self.goal_timeout)
        check(self.attempts >= 1, "attempts", "at least 1", self.attempts)
        check(self.retry_seconds >= 0.0, "retry_seconds", "zero or more", self.retry_seconds)
        policies = ", ".join(FAILURE_POLICIES)
        check(self.on_failure in FAILURE_POLICIES, "on_failure", f"one of {policies}", self.on_failure)
        check(self.order in ORDERS, "order", f"one of {', '.join(ORDERS)}", self.order)


@dataclass(frozen=True)
class NodeSettings:
    """What the node carries out, and where it finds what it needs. Waits are in wall-clock seconds."""

    zones_file: str = ""
    mission_file: str = ""
    serve: bool = False
    wait_for: str = ""
    frame_id: str = "map"
    server_timeout: float = 60.0
    map_timeout: float = 10.0

    def __post_init__(self):
        check(bool(self.zones_file), "zones_file", "the path of a YAML file of zones", self.zones_file)
        check(self.server_timeout > 0.0, "server_timeout", "positive", self.server_timeout)
        check(self.map_timeout > 0.0, "map_timeout", "positive", self.map_timeout)
