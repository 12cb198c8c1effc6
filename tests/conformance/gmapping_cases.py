"""Statements of gmapping 1.4: gmapping/src/slam_gmapping.cpp and https://wiki.ros.org/gmapping.

The input of a case is a run of ``observe_gmapping`` (``parameters``, ``steps``, ``tilt`` of the laser,
``frames``) and its ``fact``.
"""

from typing import Any

from case import SAME, Case
from node_rig import node_rig

SOURCE, MATCHER = "gmapping/src/slam_gmapping.cpp", "gmapping/scanmatcher/scanmatcher.cpp"
SMALL = {"xmin": -5.0, "ymin": -4.0, "xmax": 5.0, "ymax": 4.0}
STANDING = {"parameters": SMALL, "steps": [["before"], ["scans", 3], ["note_map"]]}


def run(
    name: str,
    fact: str,
    expected: Any,
    official: Any = SAME,
    reason: str = "",
    source: str = SOURCE,
    **given: Any,
):
    """A case; without further input a robot stands in a room."""
    return Case(name, source, "gmapping", {**(given or STANDING), "fact": fact}, expected, official, reason)


def after(*steps: Any, **parameters: Any) -> Any:
    """A run with these steps, after which the map is looked at."""
    return {"parameters": {**SMALL, **parameters}, "steps": [*steps, ["note_map"]]}


TILTED = {"parameters": SMALL, "tilt": 0.2, "steps": [["scans", 3], ["note_map"]]}
NAMED = {
    "parameters": {
        **SMALL,
        "base_frame": "base",
        "map_frame": "world",
        "transform_publish_period": 0.2,
        "tf_delay": 0.5,
        "delta": 0.1,
    },
    "frames": {"base_frame": "base"},
    "steps": [["before"], ["scans", 3], ["note_map"]],
}
NO_TF = {"parameters": {**SMALL, "transform_publish_period": 0.0}, "steps": [["before"]]}
# Defaults in ``SlamGMapping::init``.
DEFAULTS = {
    "throttle_scans": 1,
    "base_frame": "base_link",
    "map_frame": "map",
    "odom_frame": "odom",
    "transform_publish_period": 0.05,
    "map_update_interval": 5.0,
    "xmin": -100.0,
    "ymin": -100.0,
    "xmax": 100.0,
    "ymax": 100.0,
    "delta": 0.05,
    "occ_thresh": 0.25,
    "srr": 0.1,
    "srt": 0.2,
    "str": 0.1,
    "stt": 0.2,
}

CASES = [
    run("map_is_an_occupancy_grid", "publishes./map", "nav_msgs/OccupancyGrid"),
    run("map_metadata_are_published", "publishes./map_metadata", "nav_msgs/MapMetaData"),
    run("entropy_is_published", "publishes./slam_gmapping/entropy", "std_msgs/Float64"),
    run("the_transform_is_published_on_tf", "publishes./tf", "tf2_msgs/TFMessage"),
    run("scan_is_subscribed_to", "subscribes./scan", "sensor_msgs/LaserScan"),
    run("dynamic_map_is_a_service", "services has /dynamic_map", True),
    run("the_transform_is_sent_before_the_first_scan", "values.tf_frames", ["map", "odom"]),
    run("the_first_transform_is_the_identity", "values.tf_is_identity", True),
    run("the_transform_is_sent_20_times_a_second", "values.tf_period < 0.06", True),
    run("the_transform_is_post_dated", "values.tf_delay > 0.02", True),
    run("the_transform_is_post_dated_by_its_period", "values.tf_delay < 0.06", True),
    run("there_is_no_map_before_the_first_scan", "values.has_map_before", False),
    run("dynamic_map_fails_before_the_first_map", "values.dynamic_map_before", "fails"),
    run("the_first_scan_makes_a_map", "values.map is known", True),
    run("the_map_has_the_map_frame", "values.map.frame", "map"),
    run("the_map_is_stamped", "values.map.has_stamp", True),
    run("map_load_time_is_0", "values.map.load_time", 0.0),
    run("the_resolution_is_delta", "values.map.resolution", 0.05),
    run("values_are_unknown_free_and_occupied", "values.map.values", [-1, 0, 100]),
    run("the_origin_has_no_yaw", "values.map.origin_yaw", 0.0),
    run("the_metadata_are_those_of_the_map", "values.map.metadata_are_the_same", True),
    run("dynamic_map_returns_the_map", "values.map.served_is_the_same", True),
    run("the_wall_behind_the_robot_is_occupied", "values.map.in_wall", 100),
    run("the_space_before_the_wall_is_free", "values.map.in_free", 0),
    run("the_map_reaches_from_xmin", "values.map.contains.0 < -4.9", True),
    run("the_map_reaches_from_ymin", "values.map.contains.1 < -3.9", True),
    run("the_map_reaches_to_xmax", "values.map.contains.2 > 4.9", True),
    run("the_map_reaches_to_ymax", "values.map.contains.3 > 3.9", True),
    run("an_interrupted_node_exits_with_0", "exit_code", 0),
    run("frames_are_those_of_the_parameters", "values.tf_frames", ["world", "odom"], **NAMED),
    run("the_map_has_the_named_frame", "values.map.frame", "world", **NAMED),
    run("delta_is_the_size_of_a_cell", "values.map.resolution", 0.1, **NAMED),
    run("transform_publish_period_is_kept", "values.tf_period > 0.18", True, **NAMED),
    run("tf_delay_post_dates_the_transform", "values.tf_delay > 0.45", True, **NAMED),
    run("a_transform_publish_period_of_0_sends_none", "values.tf_frames", None, **NO_TF),
    run("a_laser_that_is_not_planar_is_refused", "values.map", None, **TILTED),
    run(
        "a_laser_that_is_not_planar_is_named",
        "log has Laser has to be mounted planar! Z-coordinate has to be 1 or -1, but gave: ",
        True,
        **TILTED,
    ),
    run(
        "ranges_of_range_max_are_dropped",
        "values.map.values",
        [-1],
        source=MATCHER,
        **after(["scans", 3, "8.0"]),
    ),
    run(
        "infinite_ranges_are_dropped", "values.map.values", [-1], source=MATCHER, **after(["scans", 3, "inf"])
    ),
    run("nan_is_dropped", "values.map.values", [-1], source=MATCHER, **after(["scans", 3, "nan"])),
    run(
        "ranges_below_range_min_are_dropped",
        "values.map.values",
        [-1],
        source=SOURCE,
        **after(["scans", 3, "0.05"]),
    ),
    run(
        "between_maxUrange_and_maxRange_nothing_is_marked",
        "values.map.occupied",
        0,
        source=MATCHER,
        **after(["scans", 3, "3.0"], maxUrange=2.0),
    ),
    run(
        "between_maxUrange_and_maxRange_space_is_cleared",
        "values.map.free > 1000",
        True,
        source=MATCHER,
        **after(["scans", 3, "3.0"], maxUrange=2.0),
    ),
    run(
        "space_is_cleared_up_to_maxUrange",
        "values.map.radius < 2.2",
        True,
        source=MATCHER,
        **after(["scans", 3, "3.0"], maxUrange=2.0),
    ),
    run(
        "above_maxRange_ranges_are_dropped",
        "values.map.values",
        [-1],
        source=MATCHER,
        **after(["scans", 3, "3.0"], maxRange=2.5),
    ),
]
RIGS = {"gmapping": node_rig("slam_lite.ros.node", "gmapping", "slam_gmapping", "observe_gmapping")}
