"""Settings of mapping: every parameter once, with its official name, default, bounds and meaning.

Names and defaults are those of gmapping 1.4 where it has the parameter.
"""

import dataclasses
from dataclasses import dataclass
from typing import Any, Dict, Tuple

from planar.config.settings import check, check_parameters, parameter

# Parameters of gmapping that steer its particle filter and have no counterpart in a pose graph.
WITHOUT_EFFECT = (
    "sigma",
    "kernelSize",
    "lstep",
    "astep",
    "iterations",
    "lsigma",
    "ogain",
    "lskip",
    "minimumScore",
    "linearUpdate",
    "angularUpdate",
    "temporalUpdate",
    "resampleThreshold",
    "particles",
    "llsamplerange",
    "llsamplestep",
    "lasamplerange",
    "lasamplestep",
)


@dataclass(frozen=True)
class MapperSettings:
    """How scans are matched, loops closed and the map drawn; metres and radians."""

    resolution: float = parameter("delta", 0.05, "size of a cell, m", 0.01, 1.0)
    occupied_threshold: float = parameter(
        "occ_thresh", 0.25, "share of hits among a cell's beams from which on it is occupied", 0.0, 1.0
    )
    max_range: float = parameter(
        "maxRange", 0.0, "readings above this, m, are dropped; 0: the scan's range_max - 0.01", 0.0
    )
    usable_range: float = parameter(
        "maxUrange",
        0.0,
        "readings above this, m, clear the way so far and mark nothing; 0: as maxRange",
        0.0,
    )
    odom_xy_per_distance: float = parameter("srr", 0.1, "odometry's position error, m per m", 0.0)
    odom_yaw_per_distance: float = parameter("srt", 0.2, "odometry's heading error, rad per m", 0.0)
    odom_xy_per_turn: float = parameter("str", 0.1, "odometry's position error, m per rad", 0.0)
    odom_yaw_per_turn: float = parameter("stt", 0.2, "odometry's heading error, rad per rad", 0.0)
    key_distance: float = parameter("key_distance", 0.2, "way after which a scan is kept, m", 0.01)
    key_angle: float = parameter("key_angle", 0.2, "turn after which a scan is kept, rad", 0.01)
    still_interval: float = parameter(
        "still_interval", 0.5, "how often scans are matched while the robot stands still, s", 0.0
    )
    window_keys: int = parameter("window_keys", 50, "most kept scans that a new one is matched to", 2)
    point_spacing: float = parameter("point_spacing", 0.03, "least distance between a scan's points, m", 0.0)
    min_response: float = parameter(
        "min_response", 0.2, "share of a scan that must fit; otherwise odometry is believed", 0.0, 1.0
    )
    close_loops: bool = parameter("close_loops", True, "recognise places seen before and mend the map")
    closure_interval: int = parameter(
        "closure_interval", 3, "kept scans from one search for closures to the next", 1
    )
    closure_min_response: float = parameter(
        "closure_min_response", 0.6, "share of the recent scans that must fit for a closure", 0.0, 1.0
    )
    closure_min_detour: float = parameter(
        "closure_min_detour", 4.0, "way since a place was seen from which on a closure is worth while, m", 0.0
    )

    def __post_init__(self):
        check_parameters(self)
        if self.max_range > 0.0:
            within = f"at most maxRange ({self.max_range:g})"
            check(self.usable_range <= self.max_range, "usable_range", within, self.usable_range)


@dataclass(frozen=True)
class NodeSettings(MapperSettings):
    """What the node needs besides."""

    map_frame: str = parameter("map_frame", "map", "frame of the map")
    odom_frame: str = parameter("odom_frame", "odom", "frame of the odometry")
    base_frame: str = parameter("base_frame", "base_link", "frame of the robot")
    throttle_scans: int = parameter("throttle_scans", 1, "process one of so many scans", 1)
    transform_publish_period: float = parameter(
        "transform_publish_period", 0.05, "how often map->odom is published, s; 0: not at all", 0.0
    )
    tf_delay: float = parameter(
        "tf_delay", -1.0, "how far map->odom is post-dated, s; -1: transform_publish_period", -1.0
    )
    map_update_interval: float = parameter(
        "map_update_interval", 5.0, "time of scans from one map to the next, s", 0.0
    )
    xmin: float = parameter("xmin", -100.0, "least extent of the published map, m")
    ymin: float = parameter("ymin", -100.0, "least extent of the published map, m")
    xmax: float = parameter("xmax", 100.0, "least extent of the published map, m")
    ymax: float = parameter("ymax", 100.0, "least extent of the published map, m")
    state: str = parameter("state", "", "file of a saved state to go on from; empty: a new map")
    localization_only: bool = parameter(
        "localization_only", False, "follow the robot in the loaded map and leave the map as it is"
    )

    def __post_init__(self):
        super().__post_init__()
        check(self.xmin < self.xmax, "xmin", f"less than xmax ({self.xmax:g})", self.xmin)
        check(self.ymin < self.ymax, "ymin", f"less than ymax ({self.ymax:g})", self.ymin)
        check(bool(self.state) or not self.localization_only, "localization_only", "used with state", True)

    @property
    def extent(self) -> Tuple[float, float, float, float]:
        """(xmin, ymin, xmax, ymax)."""
        return self.xmin, self.ymin, self.xmax, self.ymax


def defaults() -> Dict[str, Tuple[Any, str]]:
    """Every parameter of the node by its official name: default and meaning."""
    return {
        field.metadata["name"]: (field.default, field.metadata["meaning"])
        for field in dataclasses.fields(NodeSettings)
    }
