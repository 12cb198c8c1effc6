"""Settings of the explorer."""

from dataclasses import dataclass

from planar.config.settings import check


@dataclass(frozen=True)
class ExplorerSettings:
    """What is worth going to, and how patient the explorer is. Metres, radians and simulated seconds.

    ``field_of_view``: how much the sensor sees at once, 0 if that has to be found out; one that does not see
    all around is turned to the frontiers within ``reach`` before the robot drives on.

    The cost of a frontier is ``potential_scale`` times the way there, plus ``orientation_scale`` times the
    turn towards it, less ``gain_scale`` times its length; the cheapest is next.
    """

    min_frontier_size: float = 0.5
    max_frontier_size: float = 2.0
    clearance: float = 0.25
    goal_clearance: float = 0.35
    reach: float = 1.5
    field_of_view: float = 0.0
    potential_scale: float = 1.0
    orientation_scale: float = 0.5
    gain_scale: float = 0.5
    switch_gain: float = 1.0
    planner_frequency: float = 1.0
    progress_timeout: float = 10.0
    map_patience: float = 6.0
    attempts: int = 2
    blacklist_radius: float = 0.4

    def __post_init__(self):
        for name in (
            "min_frontier_size",
            "reach",
            "planner_frequency",
            "progress_timeout",
            "blacklist_radius",
        ):
            check(getattr(self, name) > 0.0, name, "positive", getattr(self, name))
        for name in (
            "clearance",
            "goal_clearance",
            "potential_scale",
            "orientation_scale",
            "gain_scale",
            "switch_gain",
            "map_patience",
            "field_of_view",
        ):
            check(getattr(self, name) >= 0.0, name, "zero or more", getattr(self, name))
        check(
            self.max_frontier_size > self.min_frontier_size,
            "max_frontier_size",
            f"more than min_frontier_size ({self.min_frontier_size:g})",
            self.max_frontier_size,
        )
        check(self.attempts >= 1, "attempts", "at least 1", self.attempts)


@dataclass(frozen=True)
class NodeSettings:
    """Frames, and how long the node waits for others, in wall-clock seconds."""

    global_frame: str = "map"
    robot_base_frame: str = "base_footprint"
    server_timeout: float = 60.0

    def __post_init__(self):
        check(self.server_timeout > 0.0, "server_timeout", "positive", self.server_timeout)
