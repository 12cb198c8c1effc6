"""Settings of the map server and the map saver, with the names of map_server 1.17."""

from dataclasses import dataclass

from planar.config.config_file import Section
from planar.config.parameters import Interval, check_parameters, parameter
from planar.config.settings import check


@dataclass(frozen=True)
class ServerSettings:
    """Settings of the map server.

    All but ``frame_id`` apply to an image given without YAML (deprecated). Each field is a node parameter;
    its meaning, unit and bounds are in its ``parameter(...)``.

    Raises:
        SettingsError: On construction, for a value out of bounds.
    """

    frame_id: str = parameter("map", "frame of the map")
    negate: int = parameter(
        0,
        "1: white means occupied",
        bounds=Interval(0, 1, words="0 or 1"),
        heading="Of an image given without YAML (deprecated).",
    )
    occupied_thresh: float = parameter(0.65, "darkness, 0 to 1, from which on a pixel is occupied")
    free_thresh: float = parameter(0.196, "darkness, 0 to 1, below which a pixel is free")

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class SaverSettings:
    """Options of the map saver: thresholds of occupied and free cells [percent].

    Raises:
        SettingsError: On construction, unless 0 <= free < occupied <= 100.
    """

    occupied_at: int = parameter(65, "cells from this value on are occupied", "percent", name="--occ")
    free_at: int = parameter(25, "cells up to this value are free", "percent", name="--free")

    def __post_init__(self):
        check(1 <= self.occupied_at <= 100, "--occ", "between 1 and 100", self.occupied_at)
        check(0 <= self.free_at < self.occupied_at, "--free", "at least 0 and below --occ", self.free_at)


CONFIG_FILES = {
    "map_lite.yaml": Section("", ServerSettings, about="Every parameter of the map server with its default.")
}
