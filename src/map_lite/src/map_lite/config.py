"""Settings of the map server and the map saver, with the names of map_server 1.17."""

from dataclasses import dataclass

from planar.config.listing import Section
from planar.config.parameters import Interval, check_parameters, parameter
from planar.config.settings import check


@dataclass(frozen=True)
class ServerSettings:
    """``frame_id``, and how an image given without YAML (deprecated) is understood."""

    frame_id: str = parameter("map", "frame of the map")
    negate: int = parameter(
        0,
        "1: white means occupied",
        bounds=Interval(0, 1, words="0 or 1"),
        heading="Of an image given without YAML (deprecated).",
    )
    occupied_thresh: float = parameter(0.65, "share of black from which on a cell is occupied")
    free_thresh: float = parameter(0.196, "share of black below which a cell is free")

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class SaverSettings:
    """From which values, percent, a cell counts as occupied or free; the options of the map saver."""

    occupied_at: int = parameter(65, "from this on occupied", "percent", name="--occ")
    free_at: int = parameter(25, "up to this free", "percent", name="--free")

    def __post_init__(self):
        check(1 <= self.occupied_at <= 100, "--occ", "between 1 and 100", self.occupied_at)
        check(0 <= self.free_at < self.occupied_at, "--free", "at least 0 and below --occ", self.free_at)


CONFIG_FILES = {
    "map_lite.yaml": Section("", ServerSettings, about="Every parameter of the map server with its default.")
}
