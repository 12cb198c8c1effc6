"""Settings of mapping: every parameter with its official name, default, bounds and meaning.

Names and defaults are those of gmapping 1.4 where it has the parameter.
"""

from dataclasses import dataclass
from typing import ClassVar, Mapping, Tuple

from planar.config.config_file import Section
from planar.config.parameters import Interval, check_parameters, parameter
from planar.config.settings import check
from slam_lite.matching.scan_matcher import CONTRACT

# Parameters of gmapping's particle filter, which have no counterpart in a pose graph.
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
    """Settings of scan matching, loop closure and rendering, in metres and radians.

    Each field is a node parameter; its meaning, unit and bounds are in its ``parameter(...)``.

    Raises:
        SettingsError: On construction, for a value out of bounds.
    """

    # Old names of parameters, which are still accepted.
    DEPRECATED_PARAMETERS: ClassVar[Mapping[str, str]] = {
        "key_distance": "keyframe_distance",
        "key_angle": "keyframe_angle",
        "window_keys": "window_keyframes",
    }

    resolution: float = parameter(0.05, "size of a cell", "m", Interval(0.01, 1.0), name="delta")
    occupied_threshold: float = parameter(
        0.25,
        "share of hits among a cell's beams from which on it is occupied",
        bounds=Interval(0.0, 1.0),
        name="occ_thresh",
    )
    max_range: float = parameter(
        0.0,
        "readings above this are dropped; 0: range_max - 0.01, or the reading that means no return",
        "m",
        Interval(0.0),
        name="maxRange",
    )
    usable_range: float = parameter(
        0.0,
        "readings above this clear up to it and mark nothing; 0: as maxRange",
        "m",
        Interval(0.0),
        name="maxUrange",
    )
    odom_xy_per_distance: float = parameter(
        0.1, "position error of odometry", "m per m", Interval(0.0), name="srr"
    )
    odom_yaw_per_distance: float = parameter(
        0.2, "heading error of odometry", "rad per m", Interval(0.0), name="srt"
    )
    odom_xy_per_turn: float = parameter(
        0.1, "position error of odometry", "m per rad", Interval(0.0), name="str"
    )
    odom_yaw_per_turn: float = parameter(
        0.2, "heading error of odometry", "rad per rad", Interval(0.0), name="stt"
    )
    keyframe_distance: float = parameter(
        0.2, "distance from the last keyframe after which a scan becomes a keyframe", "m", Interval(0.01)
    )
    keyframe_angle: float = parameter(
        0.2, "turn since the last keyframe after which a scan becomes a keyframe", "rad", Interval(0.01)
    )
    still_interval: float = parameter(
        0.5, "period of scan matching while the robot stands still", "s", Interval(0.0)
    )
    window_keyframes: int = parameter(
        50, "largest number of recent keyframes that a scan is matched to", bounds=Interval(2)
    )
    point_spacing: float = parameter(0.03, "least distance between the points of a scan", "m", Interval(0.0))
    min_response: float = parameter(
        0.2,
        "least share of a scan that matches; below it odometry is used instead",
        bounds=Interval(0.0, 1.0),
    )
    matcher_plugin: str = parameter("", "custom scan matcher, package.module/Matcher")
    close_loops: bool = parameter(True, "whether to close loops at places seen before")
    closure_interval: int = parameter(
        3, "keyframes from one search for loop closures to the next", bounds=Interval(1)
    )
    closure_min_response: float = parameter(
        0.6, "least share of the recent keyframes that matches for a loop closure", bounds=Interval(0.0, 1.0)
    )
    closure_min_detour: float = parameter(
        4.0, "least path length since a place was seen for a loop closure", "m", Interval(0.0)
    )

    def __post_init__(self):
        check_parameters(self)
        if self.max_range > 0.0:
            within = f"at most maxRange ({self.max_range:g})"
            check(self.usable_range <= self.max_range, "usable_range", within, self.usable_range)
        if self.matcher_plugin:
            CONTRACT.load_required(self.matcher_plugin, "matcher_plugin")


@dataclass(frozen=True)
class NodeSettings(MapperSettings):
    """Settings of the node: those of the mapper, and those of frames, topics and files.

    Raises:
        SettingsError: On construction, for a value out of bounds or a combination that is not possible.
    """

    map_frame: str = parameter("map", "frame of the map")
    odom_frame: str = parameter("odom", "frame of the odometry")
    base_frame: str = parameter("base_link", "frame of the robot")
    throttle_scans: int = parameter(1, "one of so many scans is processed", bounds=Interval(1))
    transform_publish_period: float = parameter(
        0.05, "period of the transform map->odom; 0: it is not published", "s", Interval(0.0)
    )
    tf_delay: float = parameter(
        -1.0, "time by which map->odom is post-dated; -1: transform_publish_period", "s", Interval(-1.0)
    )
    map_update_interval: float = parameter(
        5.0, "time from one published map to the next, by the stamps of scans", "s", Interval(0.0)
    )
    xmin: float = parameter(-100.0, "smallest x that the published map contains at least", "m")
    ymin: float = parameter(-100.0, "smallest y that the published map contains at least", "m")
    xmax: float = parameter(100.0, "largest x that the published map contains at least", "m")
    ymax: float = parameter(100.0, "largest y that the published map contains at least", "m")
    state: str = parameter("", "state file to resume from; empty: a new map")
    localization_only: bool = parameter(False, "whether to localize in the loaded map and leave it unchanged")
    resume: bool = parameter(
        False, "whether to save checkpoints of the map, and resume from them when the node is respawned"
    )

    def __post_init__(self):
        super().__post_init__()
        check(self.xmin < self.xmax, "xmin", f"less than xmax ({self.xmax:g})", self.xmin)
        check(self.ymin < self.ymax, "ymin", f"less than ymax ({self.ymax:g})", self.ymin)
        check(bool(self.state) or not self.localization_only, "localization_only", "used with state", True)

    @property
    def extent(self) -> Tuple[float, float, float, float]:
        """Least extent of the published map in the map frame, ``(xmin, ymin, xmax, ymax)`` [m]."""
        return self.xmin, self.ymin, self.xmax, self.ymax


CONFIG_FILES = {
    "slam_lite.yaml": Section(
        "",
        NodeSettings,
        about="Every parameter of slam_lite with its default: the official gmapping's names and values, "
        "then those of slam_lite.",
    )
}
