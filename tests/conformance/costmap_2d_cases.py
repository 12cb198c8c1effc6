"""Statements of costmap_2d 1.17: its source, its .cfg files and https://wiki.ros.org/costmap_2d."""

import math
from typing import Any, Dict, List

from case import Case, Rig

INF = math.inf
STATIC, OBSTACLES = "costmap_2d::StaticLayer", "costmap_2d::ObstacleLayer"
VOXELS, INFLATION = "costmap_2d::VoxelLayer", "costmap_2d::InflationLayer"
# Maps of 5 x 5 m with cells of 0.5 m; the robot stands at (1.25, 1.25).
EMPTY = "\n".join(10 * [10 * "."])
WALL = "\n".join(10 * ["......#..."])
VIRTUAL = "\n".join([10 * "."] * 2 + ["########.."] + [10 * "."] * 7)
UNKNOWN = "\n".join(10 * ["......?..."])
IN_WALL, IN_VIRTUAL, IN_FREE = (3.25, 0.75), (0.75, 3.75), (0.75, 0.75)
WALLS = {"real": IN_WALL, "virtual": IN_VIRTUAL, "free": IN_FREE}
AHEAD = {"ahead": (2.75, 1.25)}
CLOUD = {"data_type": "PointCloud2"}
SCAN = {"data_type": "LaserScan"}
AT_AHEAD = [[1.5, 0.0, 0.2]]


def costmap(*layers: Any, **values: Any) -> Dict[str, Any]:
    """Parameters of a costmap of 5 x 5 m in the map frame; layers are (name, type, parameters)."""
    given = {
        "global_frame": "map",
        "robot_base_frame": "base_link",
        "width": 5,
        "height": 5,
        "resolution": 0.5,
        "robot_radius": 0.2,
        "footprint_padding": 0.0,
        **values,
    }
    if layers:
        given["plugins"] = [{"name": name, "type": kind} for name, kind, _ in layers]
        given.update({name: parameters for name, _, parameters in layers if parameters})
    return given


def sources(topic: str = "cloud", layer: Any = (), **source: Any) -> Dict[str, Any]:
    """Parameters of an obstacle layer with one source named as its topic."""
    return {"observation_sources": topic, topic: {**CLOUD, **source}, **dict(layer)}


def static(name: str, topic: str = "map", **values: Any) -> Any:
    return name, STATIC, {"map_topic": topic, **values}


def obstacles(name: str = "obstacles", **values: Any) -> Any:
    return name, OBSTACLES, {**sources(), **values}


def cells(**values: int) -> Any:
    """A map whose cell at IN_WALL has a value."""
    rows = [[0] * 10 for _ in range(10)]
    rows[1][6] = values["value"]
    return rows


def statement(
    name: str, source: str, parameters: Dict[str, Any], probes: Any, expected: Any, **others: Any
) -> Case:
    official = {key: others.pop(key) for key in ("official", "reason") if key in others}
    inputs = {"costmap": parameters, "probes": probes, **others}
    return Case(name, f"costmap_2d/{source}", "costmap_2d", inputs, expected, **official)


def decayed(distance: float, radius: float, factor: float = 1.0) -> int:
    """Published occupancy beside an obstacle, for a round robot of 16 corners (computeCost)."""
    cost = int(252 * math.exp(-factor * (distance - radius * math.cos(math.pi / 16))))
    return 1 + (97 * (cost - 1)) // 251


NEXT, SECOND, THIRD = decayed(0.5, 0.2), decayed(1.0, 0.2), decayed(1.5, 0.2)
STATIC_CPP, OBSTACLE_CPP = "plugins/static_layer.cpp", "plugins/obstacle_layer.cpp"
INFLATION_CPP, ROS_CPP = "plugins/inflation_layer.cpp", "src/costmap_2d_ros.cpp"
TWO_MAPS = {"map": WALL, "walls": VIRTUAL}
HIT = {"ahead": 100}
MISS = {"ahead": 0}

STATIC_LAYER: List[Case] = [
    statement(
        "two_static_layers_with_use_maximum_both_count",
        f"{STATIC_CPP}: updateWithMax",
        costmap(static("real"), static("virtual", "walls", use_maximum=True)),
        WALLS,
        {"real": 100, "virtual": 100, "free": 0},
        maps=TWO_MAPS,
    ),
    statement(
        "a_later_static_layer_without_use_maximum_replaces_an_earlier_one",
        f"{STATIC_CPP}: updateWithTrueOverwrite",
        costmap(static("real"), static("virtual", "walls")),
        WALLS,
        {"real": 0, "virtual": 100, "free": 0},
        maps=TWO_MAPS,
    ),
    statement(
        "a_static_layer_that_is_not_enabled_adds_nothing",
        f"{STATIC_CPP}: reconfigureCB",
        costmap(static("real"), static("virtual", "walls", use_maximum=True, enabled=False)),
        WALLS,
        {"real": 100, "virtual": 0, "free": 0},
        maps=TWO_MAPS,
    ),
    statement(
        "a_static_layer_that_is_not_enabled_still_sets_the_size",
        f"{STATIC_CPP}: incomingMap resizes",
        costmap(static("real", enabled=False), obstacles(), width=3, height=3),
        {"size": (), **WALLS},
        {"size": (10, 10), "real": 0, "virtual": 0, "free": 0},
        maps={"map": WALL},
    ),
    statement(
        "the_default_topic_is_map",
        f"{STATIC_CPP}: map_topic",
        costmap(("real", STATIC, {"use_maximum": False})),
        WALLS,
        {"real": 100, "virtual": 0, "free": 0},
        maps={"map": WALL},
    ),
    statement(
        "a_trinary_layer_has_no_values_between_free_and_lethal",
        f"{STATIC_CPP}: interpretValue",
        costmap(static("real")),
        {"cell": IN_WALL},
        {"cell": 0},
        maps={"map": cells(value=50)},
    ),
    statement(
        "a_layer_that_is_not_trinary_scales_values",
        f"{STATIC_CPP}: interpretValue",
        costmap(static("real", trinary_costmap=False)),
        {"cell": IN_WALL},
        {"cell": 49},
        maps={"map": cells(value=50)},
    ),
    statement(
        "a_scaled_value_depends_on_the_threshold",
        f"{STATIC_CPP}: interpretValue",
        costmap(static("real", trinary_costmap=False, lethal_cost_threshold=60)),
        {"cell": IN_WALL},
        {"cell": 49},
        maps={"map": cells(value=30)},
    ),
    statement(
        "values_from_the_threshold_on_are_lethal",
        f"{STATIC_CPP}: lethal_cost_threshold",
        costmap(static("real", lethal_cost_threshold=60)),
        {"cell": IN_WALL},
        {"cell": 100},
        maps={"map": cells(value=60)},
    ),
    statement(
        "values_below_the_default_threshold_of_100_are_free",
        f"{STATIC_CPP}: lethal_cost_threshold",
        costmap(static("real")),
        {"cell": IN_WALL},
        {"cell": 0},
        maps={"map": cells(value=99)},
    ),
    statement(
        "a_threshold_above_100_counts_as_100",
        f"{STATIC_CPP}: std::min(temp_lethal_threshold, 100)",
        costmap(static("real", lethal_cost_threshold=150)),
        {"cell": IN_WALL},
        {"cell": 100},
        maps={"map": cells(value=100)},
    ),
    statement(
        "a_threshold_of_0_makes_free_cells_lethal",
        f"{STATIC_CPP}: std::max(..., 0)",
        costmap(static("real", lethal_cost_threshold=-5)),
        {"cell": IN_FREE},
        {"cell": 100},
        maps={"map": WALL},
    ),
    statement(
        "unknown_cost_value_chooses_the_value_of_unknown_cells",
        f"{STATIC_CPP}: unknown_cost_value",
        costmap(static("real", unknown_cost_value=50)),
        {"cell": IN_WALL},
        {"cell": -1},
        maps={"map": cells(value=50)},
    ),
    statement(
        "minus_one_is_lethal_if_another_value_means_unknown",
        f"{STATIC_CPP}: values are unsigned char",
        costmap(static("real", unknown_cost_value=50)),
        {"cell": IN_WALL},
        {"cell": 100},
        maps={"map": UNKNOWN},
    ),
    statement(
        "unknown_cells_are_tracked_by_default",
        f"{STATIC_CPP}: track_unknown_space true",
        costmap(static("real")),
        {"cell": IN_WALL},
        {"cell": -1},
        maps={"map": UNKNOWN},
    ),
    statement(
        "unknown_cells_are_free_without_track_unknown_space",
        f"{STATIC_CPP}: track_unknown_space",
        costmap(static("real", track_unknown_space=False)),
        {"cell": IN_WALL},
        {"cell": 0},
        maps={"map": UNKNOWN},
    ),
    statement(
        "track_unknown_space_of_the_costmap_replaces_that_of_static_layers",
        f"{ROS_CPP}: copyParentParameters",
        costmap(static("real", track_unknown_space=True), track_unknown_space=False),
        {"cell": IN_WALL},
        {"cell": 0},
        maps={"map": UNKNOWN},
    ),
    statement(
        "map_topic_of_the_costmap_replaces_that_of_static_layers",
        f"{ROS_CPP}: copyParentParameters",
        costmap(static("real"), map_topic="walls"),
        WALLS,
        {"real": 0, "virtual": 100, "free": 0},
        maps=TWO_MAPS,
    ),
    statement(
        "unknown_cells_of_a_layer_with_use_maximum_keep_what_lies_below",
        f"{STATIC_CPP}: updateWithMax skips NO_INFORMATION",
        costmap(static("real"), static("virtual", "walls", use_maximum=True)),
        {"cell": IN_WALL},
        {"cell": 100},
        maps={"map": WALL, "walls": UNKNOWN},
    ),
    statement(
        "a_layer_without_use_maximum_overwrites_with_unknown",
        f"{STATIC_CPP}: updateWithTrueOverwrite",
        costmap(static("real"), static("virtual", "walls")),
        {"cell": IN_WALL},
        {"cell": -1},
        maps={"map": WALL, "walls": UNKNOWN},
    ),
    statement(
        "a_static_layer_in_a_rolling_costmap_is_transformed_to_its_frame",
        f"{STATIC_CPP}: updateCosts, rolling",
        costmap(static("real"), global_frame="odom", rolling_window=True),
        {"at_wall": (4.25, 1.25), "beside": (3.25, 1.25)},
        {"at_wall": 100, "beside": 0},
        maps={"map": WALL},
        base=(2.75, 1.25, 0.0),
        map_in_odom=(1.0, 0.0, 0.0),
    ),
    statement(
        "a_map_in_the_frame_of_a_rolling_costmap_is_not_moved",
        f"{STATIC_CPP}: map_frame_",
        costmap(static("real"), global_frame="odom", rolling_window=True),
        {"at_wall": (4.25, 1.25), "in_odom": (3.25, 1.25)},
        {"at_wall": 0, "in_odom": 100},
        maps={"map": (WALL, "odom")},
        base=(2.75, 1.25, 0.0),
        map_in_odom=(1.0, 0.0, 0.0),
    ),
    statement(
        "cells_outside_the_map_keep_what_lies_below_in_a_rolling_costmap",
        f"{STATIC_CPP}: worldToMap fails",
        costmap(static("real"), global_frame="odom", rolling_window=True, track_unknown_space=True),
        {"inside": (0.25, 1.25), "outside": (-0.75, 1.25)},
        {"inside": 0, "outside": -1},
        maps={"map": WALL},
        base=(1.25, 1.25, 0.0),
    ),
    statement(
        "two_static_layers_count_in_a_rolling_costmap",
        f"{STATIC_CPP}: updateCosts, rolling, use_maximum",
        costmap(
            static("real"),
            static("virtual", "walls", use_maximum=True),
            global_frame="odom",
            rolling_window=True,
        ),
        {"real": IN_WALL, "virtual": IN_VIRTUAL},
        {"real": 100, "virtual": 100},
        maps=TWO_MAPS,
        base=(2.25, 2.25, 0.0),
    ),
    statement(
        "unknown_cells_keep_what_lies_below_in_a_rolling_costmap_too",
        f"{STATIC_CPP}: std::max of raw costs, where unknown is 255",
        costmap(
            static("real"),
            static("virtual", "walls", use_maximum=True),
            global_frame="odom",
            rolling_window=True,
        ),
        {"cell": IN_WALL},
        {"cell": 100},
        official={"cell": -1},
        reason="unknown cells of one map would erase walls of another",
        maps={"map": WALL, "walls": UNKNOWN},
        base=(2.25, 2.25, 0.0),
    ),
]

OBSTACLE_LAYER: List[Case] = [
    statement(
        "points_are_marked_by_default",
        f"{OBSTACLE_CPP}: marking true",
        costmap(obstacles()),
        AHEAD,
        HIT,
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "a_source_with_marking_false_marks_nothing",
        f"{OBSTACLE_CPP}: marking",
        costmap(obstacles(cloud={**CLOUD, "marking": False})),
        AHEAD,
        MISS,
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "points_do_not_clear_by_default",
        f"{OBSTACLE_CPP}: clearing false",
        costmap(obstacles()),
        AHEAD,
        HIT,
        steps=[[("cloud", AT_AHEAD)], [("cloud", [[2.4, 0.0, 0.2]])]],
    ),
    statement(
        "a_clearing_source_clears_up_to_its_points",
        f"{OBSTACLE_CPP}: raytraceFreespace",
        costmap(obstacles(cloud={**CLOUD, "clearing": True})),
        AHEAD,
        MISS,
        steps=[[("cloud", AT_AHEAD)], [("cloud", [[2.4, 0.0, 0.2]])]],
    ),
    statement(
        "a_second_obstacle_layer_that_is_not_enabled_leaves_the_first_alone",
        f"{OBSTACLE_CPP}: enabled",
        costmap(obstacles("first"), obstacles("second", enabled=False)),
        AHEAD,
        HIT,
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "an_obstacle_layer_that_is_not_enabled_adds_nothing",
        f"{OBSTACLE_CPP}: enabled",
        costmap(obstacles(enabled=False), obstacles("other", **sources("other"))),
        AHEAD,
        MISS,
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "heights_are_those_of_each_layer",
        f"{OBSTACLE_CPP}: max_obstacle_height",
        costmap(obstacles("low", max_obstacle_height=0.1), obstacles("high", **sources("other"))),
        {**AHEAD, "left": (1.25, 2.75)},
        {"ahead": 0, "left": 100},
        steps=[[("cloud", AT_AHEAD), ("other", [[0.0, 1.5, 0.2]])]],
    ),
    statement(
        "combination_method_0_overwrites_the_map",
        f"{OBSTACLE_CPP}: updateWithOverwrite",
        costmap(static("real"), obstacles(combination_method=0)),
        WALLS,
        {"real": 0, "virtual": 0, "free": 0},
        maps={"map": WALL},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "combination_method_1_keeps_the_higher_cost",
        f"{OBSTACLE_CPP}: updateWithMax",
        costmap(static("real"), obstacles()),
        {**WALLS, **AHEAD},
        {"real": 100, "virtual": 0, "free": 0, "ahead": 100},
        maps={"map": WALL},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "combination_method_99_ignores_the_layer",
        f"{OBSTACLE_CPP}: default: Nothing",
        costmap(static("real"), obstacles(combination_method=99)),
        {"real": IN_WALL, **AHEAD},
        {"real": 100, "ahead": 0},
        maps={"map": WALL},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "obstacle_range_is_2_5_by_default",
        f"{OBSTACLE_CPP}: obstacle_range",
        costmap(obstacles()),
        {"near": (3.65, 1.25), "far": (1.25, 3.8)},
        {"near": 100, "far": 0},
        steps=[[("cloud", [[2.4, 0.0, 0.1], [0.0, 2.55, 0.1]])]],
    ),
    statement(
        "obstacle_range_is_measured_in_three_dimensions",
        f"{OBSTACLE_CPP}: sq_dist",
        costmap(obstacles()),
        {"far": (3.65, 1.25)},
        {"far": 0},
        steps=[[("cloud", [[2.4, 0.0, 1.0]])]],
    ),
    statement(
        "obstacle_range_is_searched_in_the_namespace_of_the_layer",
        f"{OBSTACLE_CPP}: searchParam",
        costmap(obstacles(obstacle_range=1.0)),
        AHEAD,
        MISS,
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "obstacle_range_is_searched_in_the_namespace_around_the_costmap",
        f"{OBSTACLE_CPP}: searchParam",
        costmap(obstacles()),
        AHEAD,
        MISS,
        outer={"obstacle_range": 1.0},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "obstacle_range_of_a_source_counts_before_that_of_the_layer",
        f"{OBSTACLE_CPP}: searchParam",
        costmap(obstacles(obstacle_range=1.0, cloud={**CLOUD, "obstacle_range": 2.0})),
        AHEAD,
        HIT,
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "obstacle_range_of_the_costmap_replaces_that_of_obstacle_layers",
        f"{ROS_CPP}: copyParentParameters",
        costmap(obstacles(obstacle_range=2.0), obstacle_range=1.0),
        AHEAD,
        MISS,
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "max_obstacle_height_of_the_costmap_replaces_that_of_obstacle_layers",
        f"{ROS_CPP}: copyParentParameters",
        costmap(obstacles(max_obstacle_height=2.0), max_obstacle_height=0.1),
        AHEAD,
        MISS,
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "max_obstacle_height_of_the_costmap_is_not_copied_to_voxel_layers",
        f"{ROS_CPP}: copyParentParameters",
        costmap(("voxels", VOXELS, sources()), max_obstacle_height=0.1),
        AHEAD,
        HIT,
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "points_above_2_m_are_not_marked_by_default",
        f"{OBSTACLE_CPP}: max_obstacle_height 2.0",
        costmap(obstacles()),
        {"low": (1.75, 1.25), "high": (1.25, 1.75)},
        {"low": 100, "high": 0},
        steps=[[("cloud", [[0.5, 0.0, 1.95], [0.0, 0.5, 2.05]])]],
    ),
    statement(
        "points_below_0_m_are_not_marked_by_default",
        f"{OBSTACLE_CPP}: min_obstacle_height 0.0",
        costmap(obstacles()),
        AHEAD,
        MISS,
        steps=[[("cloud", [[1.5, 0.0, -0.05]])]],
    ),
    statement(
        "points_outside_the_heights_of_their_source_do_not_clear",
        "src/observation_buffer.cpp: bufferCloud",
        costmap(obstacles(cloud={**CLOUD, "clearing": True, "max_obstacle_height": 1.0})),
        AHEAD,
        HIT,
        steps=[[("cloud", AT_AHEAD)], [("cloud", [[2.4, 0.0, 1.5]])]],
    ),
    statement(
        "clearing_ends_at_raytrace_range",
        f"{OBSTACLE_CPP}: raytrace_range",
        costmap(
            obstacles(cloud={**CLOUD, "clearing": True, "raytrace_range": 1.0, "obstacle_range": 1.0}),
            obstacles("marks", **sources("marks"), combination_method=1),
        ),
        AHEAD,
        HIT,
        steps=[[("marks", AT_AHEAD)], [("cloud", [[2.4, 0.0, 0.2]])]],
    ),
    statement(
        "a_source_marks_what_it_saw_last_until_it_sees_something_else",
        "src/observation_buffer.cpp: the newest observation is kept",
        costmap(
            (
                "obstacles",
                OBSTACLES,
                {
                    "observation_sources": "bumper laser",
                    "bumper": CLOUD,
                    "laser": {**CLOUD, "clearing": True},
                },
            )
        ),
        AHEAD,
        HIT,
        steps=[[("bumper", AT_AHEAD)], [("laser", [[2.4, 0.0, 0.2]])], [("laser", [[2.4, 0.0, 0.2]])]],
    ),
    statement(
        "one_topic_may_be_two_sources",
        f"{OBSTACLE_CPP}: observation_sources",
        costmap(
            (
                "obstacles",
                OBSTACLES,
                {
                    "observation_sources": "mark clear",
                    "mark": {**CLOUD, "topic": "cloud"},
                    "clear": {**CLOUD, "topic": "cloud", "marking": False, "clearing": True},
                },
            )
        ),
        {**AHEAD, "behind": (3.65, 1.25)},
        {"ahead": 0, "behind": 100},
        steps=[[("cloud", AT_AHEAD)], [("cloud", [[2.4, 0.0, 0.2]])]],
    ),
    statement(
        "the_footprint_is_cleared",
        f"{OBSTACLE_CPP}: footprint_clearing_enabled true",
        costmap(obstacles(), robot_radius=0.6),
        {"under": (1.25, 1.25), **AHEAD},
        {"under": 0, "ahead": 100},
        steps=[[("cloud", [[0.1, 0.1, 0.2], *AT_AHEAD])]],
    ),
    statement(
        "the_footprint_is_not_cleared_without_footprint_clearing_enabled",
        f"{OBSTACLE_CPP}: footprint_clearing_enabled",
        costmap(obstacles(footprint_clearing_enabled=False), robot_radius=0.6),
        {"under": (1.25, 1.25)},
        {"under": 100},
        steps=[[("cloud", [[0.1, 0.1, 0.2]])]],
    ),
    statement(
        "cells_that_were_not_observed_are_unknown_if_the_costmap_tracks_them",
        f"{OBSTACLE_CPP}: isTrackingUnknown",
        costmap(obstacles(), track_unknown_space=True),
        {"ahead": (2.75, 1.25), "unseen": (0.25, 4.75)},
        {"ahead": 100, "unseen": -1},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "infinite_ranges_do_not_clear_by_default",
        f"{OBSTACLE_CPP}: inf_is_valid false",
        costmap(obstacles(observation_sources="scan", scan={**SCAN, "clearing": True})),
        AHEAD,
        HIT,
        steps=[[("scan", [1.5, 1.0, 1.0, 1.0])], [("scan", [INF, 1.0, 1.0, 1.0])]],
    ),
    statement(
        "infinite_ranges_clear_with_inf_is_valid",
        f"{OBSTACLE_CPP}: laserScanValidInfCallback",
        costmap(obstacles(observation_sources="scan", scan={**SCAN, "clearing": True, "inf_is_valid": True})),
        AHEAD,
        MISS,
        steps=[[("scan", [1.5, 1.0, 1.0, 1.0])], [("scan", [INF, 1.0, 1.0, 1.0])]],
    ),
    statement(
        "ranges_below_range_min_are_ignored",
        "laser_geometry: range_min",
        costmap(obstacles(observation_sources="scan", scan=SCAN, footprint_clearing_enabled=False)),
        {"here": (1.25, 1.25), "left": (1.25, 2.25)},
        {"here": 0, "left": 100},
        steps=[[("scan", [0.04, 1.0, 1.0, 1.0])]],
    ),
    statement(
        "the_topic_of_a_source_is_its_name_by_default",
        f"{OBSTACLE_CPP}: topic",
        costmap(("obstacles", OBSTACLES, {"observation_sources": "bump", "bump": CLOUD})),
        AHEAD,
        HIT,
        steps=[[("bump", AT_AHEAD)]],
    ),
    statement(
        "a_table_that_observation_sources_does_not_list_is_no_source",
        f"{OBSTACLE_CPP}: observation_sources",
        costmap(obstacles(observation_sources="other", other=CLOUD)),
        AHEAD,
        MISS,
        steps=[[("cloud", AT_AHEAD), ("other", [[0.0, 1.5, 0.2]])]],
    ),
    statement(
        "the_end_of_a_ray_is_kept_if_its_source_does_not_mark",
        f"{OBSTACLE_CPP}: raytraceLine includes its end",
        costmap(
            (
                "obstacles",
                OBSTACLES,
                {
                    "observation_sources": "mark clear",
                    "mark": CLOUD,
                    "clear": {**CLOUD, "marking": False, "clearing": True},
                },
            )
        ),
        AHEAD,
        HIT,
        steps=[[("mark", AT_AHEAD)], [("clear", AT_AHEAD), ("mark", [[0.0, 1.5, 0.2]])]],
        official=MISS,
        reason="a return is no free space; the official layer erases what the sensor sees",
    ),
]

VOXEL_CPP, GRID_H = "plugins/voxel_layer.cpp", "voxel_grid/voxel_grid.h"
LOW, HIGH, BEYOND = [1.0, 0.0, 0.1], [1.0, 0.0, 1.0], [2.9, 0.0, 0.1]
AT_LOW = {"cell": (2.25, 1.25)}
TRACKED = {"track_unknown_space": True}
SHORT = {**CLOUD, "clearing": True, "marking": False, "raytrace_range": 0.5}


def voxels(
    name: str, source: str, expected: int, *clouds: Any, cell: Any = AT_LOW, around: Any = (), **values: Any
) -> Case:
    """The occupancy of a cell after clouds, one an update; ``around``: further parameters of the costmap."""
    layer = ("voxels", VOXELS, {**sources(clearing=True), **values})
    steps = [[("cloud", cloud)] for cloud in clouds]
    return statement(name, source, costmap(layer, **dict(around)), cell, {"cell": expected}, steps=steps)


VOXEL_LAYER: List[Case] = [
    voxels("a_voxel_layer_marks_points_within_its_heights", f"{VOXEL_CPP}: updateBounds", 100, [LOW]),
    voxels(
        "mark_threshold_is_the_most_marked_voxels_of_a_free_column",
        f"{GRID_H}: markVoxelInMap",
        0,
        [LOW],
        mark_threshold=1,
    ),
    voxels(
        "more_marked_voxels_than_mark_threshold_are_lethal",
        f"{GRID_H}: markVoxelInMap",
        100,
        [LOW, HIGH],
        mark_threshold=1,
    ),
    voxels(
        "two_points_in_one_voxel_count_once",
        f"{GRID_H}: markVoxelInMap",
        0,
        [LOW, [1.0, 0.0, 0.15]],
        mark_threshold=1,
    ),
    voxels(
        "points_above_the_highest_voxel_are_not_marked", f"{VOXEL_CPP}: worldToMap3D", 0, [HIGH], z_voxels=4
    ),
    voxels(
        "z_resolution_is_the_height_of_a_voxel",
        f"{VOXEL_CPP}: worldToMap3D",
        100,
        [HIGH],
        z_voxels=4,
        z_resolution=0.3,
    ),
    voxels(
        "sixteen_voxels_are_the_most_of_a_column",
        f"{GRID_H}: sizes <= 16",
        100,
        [[1.0, 0.0, 1.55]],
        z_voxels=16,
        z_resolution=0.1,
    ),
    voxels(
        "a_point_below_origin_z_is_marked_in_the_lowest_voxel",
        f"{VOXEL_CPP}: updateBounds",
        100,
        [LOW],
        origin_z=0.5,
    ),
    voxels("a_ray_clears_the_voxels_it_passes", f"{GRID_H}: clearVoxelLineInMap", 0, [LOW], [BEYOND]),
    voxels(
        "a_ray_below_an_obstacle_does_not_clear_it", f"{GRID_H}: clearVoxelLineInMap", 100, [HIGH], [BEYOND]
    ),
    voxels(
        "a_cell_stays_lethal_while_another_voxel_is_marked",
        f"{GRID_H}: ClearVoxelInMap",
        100,
        [LOW, HIGH],
        [BEYOND],
    ),
    voxels(
        "a_cell_is_free_when_no_more_voxels_than_mark_threshold_are_left",
        f"{GRID_H}: ClearVoxelInMap",
        0,
        [LOW, HIGH],
        [BEYOND],
        mark_threshold=1,
    ),
    voxels(
        "a_ray_ends_two_cells_before_its_return",
        f"{VOXEL_CPP}: raytraceFreespace: 2 * resolution_",
        100,
        [LOW],
        [[1.7, 0.0, 0.1]],
    ),
    statement(
        "a_ray_is_cut_at_raytrace_range",
        f"{VOXEL_CPP}: raytrace_range",
        costmap(("voxels", VOXELS, {"observation_sources": "mark clear", "mark": CLOUD, "clear": SHORT})),
        AT_LOW,
        {"cell": 100},
        steps=[[("mark", [LOW])], [("clear", [BEYOND])]],
    ),
    voxels(
        "a_sensor_below_the_lowest_voxel_does_not_clear",
        f"{VOXEL_CPP}: raytraceFreespace: out of map bounds",
        100,
        [LOW],
        [BEYOND],
        origin_z=0.05,
    ),
    voxels(
        "a_point_above_the_layer_is_not_marked_but_clears_up_to_its_height",
        f"{VOXEL_CPP}: raytraceFreespace: max_obstacle_height_",
        0,
        [LOW],
        [[2.9, 0.0, 0.3]],
        max_obstacle_height=0.25,
    ),
    voxels(
        "a_ray_that_rises_above_the_layer_clears_no_further",
        f"{VOXEL_CPP}: raytraceFreespace: max_obstacle_height_",
        100,
        [LOW],
        [[2.0, 0.0, 1.9]],
        max_obstacle_height=0.15,
    ),
    voxels(
        "a_cleared_column_is_unknown_above_unknown_threshold",
        f"{GRID_H}: ClearVoxelInMap",
        -1,
        [BEYOND],
        unknown_threshold=8,
        around=TRACKED,
    ),
    voxels(
        "a_cleared_column_is_free_up_to_unknown_threshold",
        f"{GRID_H}: ClearVoxelInMap",
        0,
        [BEYOND],
        unknown_threshold=9,
        around=TRACKED,
    ),
    voxels(
        "a_column_that_no_ray_passes_stays_unknown",
        f"{GRID_H}: resize",
        -1,
        [BEYOND],
        cell={"cell": (2.25, 3.25)},
        around=TRACKED,
    ),
    statement(
        "points_above_the_height_of_an_obstacle_layer_clear",
        f"{OBSTACLE_CPP}: raytraceFreespace",
        costmap(obstacles(max_obstacle_height=0.5, **sources(clearing=True))),
        AT_LOW,
        {"cell": 0},
        steps=[[("cloud", [LOW])], [("cloud", [[2.4, 0.0, 0.9]])]],
    ),
]

ORDER: List[Case] = [
    statement(
        "a_static_layer_above_an_obstacle_layer_replaces_its_marks",
        "src/layered_costmap.cpp: layers run in the order of the list",
        costmap(obstacles(), static("real")),
        {"real": IN_WALL, **AHEAD},
        {"real": 100, "ahead": 0},
        maps={"map": WALL},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "an_inflation_layer_below_an_obstacle_layer_does_not_inflate_it",
        "src/layered_costmap.cpp: layers run in the order of the list",
        costmap(("inflation", INFLATION, {"inflation_radius": 1.0}), obstacles()),
        {**AHEAD, "beside": (2.75, 1.75)},
        {"ahead": 100, "beside": 0},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "of_two_inflation_layers_the_higher_cost_counts",
        f"{INFLATION_CPP}: std::max(old_cost, cost)",
        costmap(
            obstacles(),
            ("narrow", INFLATION, {"inflation_radius": 0.5, "cost_scaling_factor": 1.0}),
            ("wide", INFLATION, {"inflation_radius": 1.5, "cost_scaling_factor": 3.0}),
        ),
        {"near": (2.75, 1.75), "far": (2.75, 2.25)},
        {"near": NEXT, "far": decayed(1.0, 0.2, 3.0)},
        steps=[[("cloud", AT_AHEAD)]],
    ),
]


def inflated(**values: Any) -> Dict[str, Any]:
    own = {key: values.pop(key) for key in [*values] if key in ("inflation_radius", "cost_scaling_factor")}
    own.update({key: values.pop(key) for key in [*values] if key in ("inflate_unknown", "enabled")})
    return costmap(obstacles(), ("inflation", INFLATION, own), **values)


AROUND = {"next": (2.75, 1.75), "second": (2.75, 2.25), "third": (2.75, 2.75)}
INFLATION_LAYER: List[Case] = [
    statement(
        "costs_decay_exponentially_from_the_inscribed_radius",
        "include/costmap_2d/inflation_layer.h: computeCost",
        inflated(inflation_radius=2.0, cost_scaling_factor=1.0),
        AROUND,
        {"next": NEXT, "second": SECOND, "third": THIRD},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "cells_within_the_inscribed_radius_are_99",
        "include/costmap_2d/inflation_layer.h: computeCost",
        inflated(inflation_radius=2.0, cost_scaling_factor=1.0, robot_radius=0.55),
        AROUND,
        {"next": 99, "second": decayed(1.0, 0.55), "third": decayed(1.5, 0.55)},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "inflation_reaches_as_many_whole_cells_as_the_radius_touches",
        f"{INFLATION_CPP}: cellDistance rounds up",
        inflated(inflation_radius=0.6, cost_scaling_factor=1.0),
        AROUND,
        {"next": NEXT, "second": SECOND, "third": 0},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "a_radius_of_0_inflates_nothing",
        f"{INFLATION_CPP}: cell_inflation_radius_ == 0",
        inflated(inflation_radius=0.0),
        {**AHEAD, **AROUND},
        {"ahead": 100, "next": 0, "second": 0, "third": 0},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "an_inflation_layer_that_is_not_enabled_adds_nothing",
        f"{INFLATION_CPP}: enabled",
        inflated(inflation_radius=2.0, enabled=False),
        {**AHEAD, **AROUND},
        {"ahead": 100, "next": 0, "second": 0, "third": 0},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "inflation_radius_of_the_costmap_replaces_that_of_inflation_layers",
        f"{ROS_CPP}: copyParentParameters",
        costmap(
            obstacles(),
            ("inflation", INFLATION, {"inflation_radius": 2.0, "cost_scaling_factor": 1.0}),
            inflation_radius=0.5,
        ),
        AROUND,
        {"next": NEXT, "second": 0, "third": 0},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "unknown_cells_stay_unknown_unless_inscribed",
        f"{INFLATION_CPP}: inflate_unknown false",
        inflated(inflation_radius=2.0, cost_scaling_factor=1.0, robot_radius=0.55, track_unknown_space=True),
        {"next": (2.75, 1.75), "second": (2.75, 2.25)},
        {"next": 99, "second": -1},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "unknown_cells_are_inflated_with_inflate_unknown",
        f"{INFLATION_CPP}: inflate_unknown",
        inflated(
            inflation_radius=2.0,
            cost_scaling_factor=1.0,
            inflate_unknown=True,
            robot_radius=0.55,
            track_unknown_space=True,
        ),
        {"next": (2.75, 1.75), "second": (2.75, 2.25)},
        {"next": 99, "second": decayed(1.0, 0.55)},
        steps=[[("cloud", AT_AHEAD)]],
    ),
]
CORNERS = [(0.2, 0.2), (0.2, -0.2), (-0.2, -0.2), (-0.2, 0.2)]
CIRCLE = [
    (round(0.4 * math.cos(k * math.pi / 8), 3) + 0.0, round(0.4 * math.sin(k * math.pi / 8), 3) + 0.0)
    for k in range(16)
]
SQUARE = [list(corner) for corner in CORNERS]
OUTLINE: Dict[str, Any] = {"footprint": ()}


def footprint(name: str, source: str, expected: Any, **values: Any) -> Case:
    differs = {key: values.pop(key) for key in ("official", "reason") if key in values}
    given = costmap(obstacles(), **{"robot_radius": 0.4, **values})
    return statement(name, f"src/{source}", given, OUTLINE, expected, steps=[[]], **differs)


FOOTPRINTS: List[Case] = [
    footprint("a_circle_has_16_corners", "footprint.cpp: makeFootprintFromRadius", {"footprint": CIRCLE}),
    footprint(
        "an_empty_footprint_means_robot_radius",
        "footprint.cpp: makeFootprintFromParams",
        {"footprint": CIRCLE},
        footprint="",
    ),
    footprint(
        "a_footprint_without_points_means_robot_radius",
        "footprint.cpp: makeFootprintFromParams",
        {"footprint": CIRCLE},
        footprint="[]",
    ),
    footprint(
        "a_footprint_may_be_a_list",
        "footprint.cpp: makeFootprintFromXMLRPC",
        {"footprint": CORNERS},
        footprint=SQUARE,
    ),
    footprint(
        "a_footprint_may_be_text",
        "footprint.cpp: makeFootprintFromString",
        {"footprint": CORNERS},
        footprint=str(SQUARE),
    ),
    footprint(
        "points_of_a_footprint_need_no_commas_between_them",
        "array_parser.cpp: parseVVF",
        {"footprint": CORNERS},
        footprint="[[0.2 0.2] [0.2 -0.2] [-0.2 -0.2] [-0.2 0.2]]",
    ),
    footprint(
        "points_of_a_footprint_may_touch",
        "array_parser.cpp: parseVVF",
        {"footprint": CORNERS},
        footprint="[[0.2,0.2][0.2,-0.2][-0.2,-0.2][-0.2,0.2]]",
    ),
    footprint(
        "a_footprint_counts_before_robot_radius",
        "footprint.cpp: makeFootprintFromParams",
        {"footprint": CORNERS},
        footprint=SQUARE,
        robot_radius=1.0,
    ),
    footprint(
        "padding_moves_corners_away_from_both_axes",
        "footprint.cpp: padFootprint",
        {"footprint": [(0.3, 0.3), (0.3, -0.3), (-0.3, -0.3), (-0.3, 0.3)]},
        footprint=SQUARE,
        footprint_padding=0.1,
    ),
    footprint(
        "a_footprint_of_two_points_is_refused",
        "footprint.cpp: at least three points",
        {"error": "local_costmap/footprint must be at least 3 points, got ((0.2, 0.2), (0.2, -0.2))"},
        official={"footprint": CIRCLE},
        reason="a robot with another outline than its file states is not safe; the official logs an error",
        footprint="[[0.2, 0.2], [0.2, -0.2]]",
    ),
]

OLD = {"observation_sources": "cloud", "cloud": CLOUD}
PRE_HYDRO: List[Case] = [
    statement(
        "without_plugins_there_are_obstacles_and_inflation",
        f"{ROS_CPP}: loadOldParameters",
        costmap(**OLD, inflation_radius=2.0, cost_scaling_factor=1.0),
        {**AHEAD, "next": (2.75, 1.75)},
        {"ahead": 100, "next": NEXT},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "static_map_adds_a_static_layer",
        f"{ROS_CPP}: loadOldParameters",
        costmap(**OLD, static_map=True, inflation_radius=0.0),
        {"real": IN_WALL, **AHEAD},
        {"real": 100, "ahead": 100},
        maps={"map": WALL},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "static_map_has_no_effect_beside_plugins",
        f"{ROS_CPP}: warnForOldParameters",
        costmap(obstacles(), static_map=True),
        {"real": IN_WALL},
        {"real": 0},
        maps={"map": WALL},
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "map_topic_is_moved_to_the_static_layer",
        f"{ROS_CPP}: loadOldParameters",
        costmap(static_map=True, map_topic="walls", inflation_radius=0.0),
        WALLS,
        {"real": 0, "virtual": 100, "free": 0},
        maps=TWO_MAPS,
    ),
    statement(
        "tables_of_sources_are_moved_to_the_obstacle_layer",
        f"{ROS_CPP}: loadOldParameters",
        costmap(**{**OLD, "cloud": {**CLOUD, "marking": False}}),
        AHEAD,
        MISS,
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "map_type_voxel_makes_the_obstacle_layer_a_voxel_layer",
        f"{ROS_CPP}: loadOldParameters",
        costmap(**OLD, map_type="voxel", inflation_radius=0.0),
        AHEAD,
        HIT,
        steps=[[("cloud", AT_AHEAD)]],
    ),
    statement(
        "footprint_clearing_enabled_is_not_moved",
        f"{ROS_CPP}: loadOldParameters",
        costmap(**OLD, footprint_clearing_enabled=False, robot_radius=0.6, inflation_radius=0.0),
        {"under": (1.25, 1.25)},
        {"under": 0},
        steps=[[("cloud", [[0.1, 0.1, 0.2]])]],
    ),
    statement(
        "a_table_named_as_a_layer_counts_without_plugins_too",
        f"{ROS_CPP}: loadOldParameters",
        costmap(**OLD, inflation_layer={"inflation_radius": 2.0, "cost_scaling_factor": 1.0}),
        {"next": (2.75, 1.75)},
        {"next": NEXT},
        steps=[[("cloud", AT_AHEAD)]],
    ),
]

CASES: List[Case] = [
    *STATIC_LAYER, *OBSTACLE_LAYER, *VOXEL_LAYER, *ORDER, *INFLATION_LAYER, *FOOTPRINTS, *PRE_HYDRO,
]  # fmt: skip


def _run_ours(given: Any) -> Any:
    from costmap_2d_rig import run_ours

    return run_ours(given)


def _run_official(given: Any) -> Any:
    from costmap_2d_official import run_official  # imports ROS

    return run_official(given)


RIGS: Dict[str, Rig] = {"costmap_2d": Rig(_run_ours, _run_official, ("costmap_2d/costmap_2d_node",))}
