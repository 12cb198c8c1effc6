"""Settings of the map server and the map saver, with the names of map_server 1.17."""

from dataclasses import dataclass

from planar.config.settings import check


@dataclass(frozen=True)
class ServerSettings:
    """``frame_id``: the map's frame. The others speak of an image given without YAML (deprecated)."""

    frame_id: str = "map"
    negate: int = 0
    occupied_thresh: float = 0.65
    free_thresh: float = 0.196

    def __post_init__(self):
        check(self.negate in (0, 1), "negate", "0 or 1", self.negate)


@dataclass(frozen=True)
class SaverSettings:
    """From which values, percent, a cell counts as occupied or free."""

    occupied_at: int = 65
    free_at: int = 25

    def __post_init__(self):
        check(1 <= self.occupied_at <= 100, "--occ", "between 1 and 100", self.occupied_at)
        check(0 <= self.free_at < self.occupied_at, "--free", "at least 0 and below --occ", self.free_at)
