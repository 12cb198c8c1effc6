"""Settings of mapping: every parameter once, with its official name, default, bounds and meaning.

Names and defaults are those of gmapping 1.4 where it has the parameter.
"""

from dataclasses import dataclass
from typing import Tuple

from planar.config.listing import Section
from planar.config.parameters import Interval, check_parameters, parameter
from planar.config.settings import check
from planar.plugins import check_plugin_name

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

    resolution: float = parameter(0.05, "size of a cell", "m", Interval(0.01, 1.0), name="delta")
    occupied_threshold: float = parameter(
        0.25,
        "share of hits among a cell's beams from which on it is occupied",
        bounds=Interval(0.0, 1.0),
        name="occ_thresh",
    )
    max_range: float = parameter(
        0.0,
        "readings above this are dropped; 0: range_max - 0.01, or what is read where nothing is seen",
        "m",
        Interval(0.0),
        name="maxRange",
    )
    usable_range: float = parameter(
        0.0,
        "readings above this clear the way so far and mark nothing; 0: as maxRange",
        "m",
        Interval(0.0),
        name="maxUrange",
    )
    odom_xy_per_distance: float = parameter(
        0.1, "odometry's position error", "m per m", Interval(0.0), name="srr"
    )
    odom_yaw_per_distance: float = parameter(
        0.2, "odometry's heading error", "rad per m", Interval(0.0), name="srt"
    )
    odom_xy_per_turn: float = parameter(
        0.1, "odometry's position error", "m per rad", Interval(0.0), name="str"
    )
    odom_yaw_per_turn: float = parameter(
        0.2, "odometry's heading error", "rad per rad", Interval(0.0), name="stt"
    )
    key_distance: float = parameter(0.2, "way after which a scan is kept", "m", Interval(0.01))
    key_angle: float = parameter(0.2, "turn after which a scan is kept", "rad", Interval(0.01))
    still_interval: float = parameter(
        0.5, "how often scans are matched while the robot stands still", "s", Interval(0.0)
    )
    window_keys: int = parameter(50, "most kept scans that a new one is matched to", bounds=Interval(2))
    point_spacing: float = parameter(0.03, "least distance between a scan's points", "m", Interval(0.0))
    min_response: float = parameter(
        0.2, "share of a scan that must fit; otherwise odometry is believed", bounds=Interval(0.0, 1.0)
    )
    matcher_plugin: str = parameter("", "your own matcher of scans, package.module/Matcher")
    close_loops: bool = parameter(True, "recognise places seen before and mend the map")
    closure_interval: int = parameter(
        3, "kept scans from one search for closures to the next", bounds=Interval(1)
    )
    closure_min_response: float = parameter(
        0.6, "share of the recent scans that must fit for a closure", bounds=Interval(0.0, 1.0)
    )
    closure_min_detour: float = parameter(
        4.0, "way since a place was seen from which on a closure is worth while", "m", Interval(0.0)
    )

    def __post_init__(self):
        check_parameters(self)
        if self.max_range > 0.0:
            within = f"at most maxRange ({self.max_range:g})"
            check(self.usable_range <= self.max_range, "usable_range", within, self.usable_range)
        if self.matcher_plugin:
            from slam_lite.matching.scan_matcher import CONTRACT  # late: it is made of these settings

            check_plugin_name("matcher_plugin", self.matcher_plugin, CONTRACT)


@dataclass(frozen=True)
class NodeSettings(MapperSettings):
    """What the node needs besides."""

    map_frame: str = parameter("map", "frame of the map")
    odom_frame: str = parameter("odom", "frame of the odometry")
    base_frame: str = parameter("base_link", "frame of the robot")
    throttle_scans: int = parameter(1, "process one of so many scans", bounds=Interval(1))
    transform_publish_period: float = parameter(
        0.05, "how often map->odom is published; 0: not at all", "s", Interval(0.0)
    )
    tf_delay: float = parameter(
        -1.0, "how far map->odom is post-dated; -1: transform_publish_period", "s", Interval(-1.0)
    )
    map_update_interval: float = parameter(5.0, "time of scans from one map to the next", "s", Interval(0.0))
    xmin: float = parameter(-100.0, "least extent of the published map", "m")
    ymin: float = parameter(-100.0, "least extent of the published map", "m")
    xmax: float = parameter(100.0, "least extent of the published map", "m")
    ymax: float = parameter(100.0, "least extent of the published map", "m")
    state: str = parameter("", "file of a saved state to go on from; empty: a new map")
    localization_only: bool = parameter(
        False, "follow the robot in the loaded map and leave the map as it is"
    )
    resume: bool = parameter(
        False, "for a node that is respawned: whether to keep the map as it grows, and to go on with it"
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


CONFIG_FILES = {
    "slam_lite.yaml": Section(
        "",
        NodeSettings,
        about="Every parameter of slam_lite with its default: the official gmapping's names and values, "
        "then its own.",
    )
}
