"""Statements of move_base 1.17, navfn, global_planner and dwa_local_planner: sources and .cfg files."""

from typing import Any, Dict, List, Tuple

from case import Case, Rig

MOVE_BASE_CPP = "move_base/src/move_base.cpp"
DWA = {"base_local_planner": "dwa_local_planner/DWAPlannerROS"}
GLOBAL_PLANNER = {"base_global_planner": "global_planner/GlobalPlanner"}
# Tables of the .cfg files: server, file, other parameters, and (name, default, low, high).
TABLES: List[Tuple[str, str, Dict[str, Any], List[Tuple[Any, ...]]]] = [
    (
        "",
        "move_base/cfg/MoveBase.cfg",
        {},
        [
            ("base_global_planner", "navfn/NavfnROS"),
            ("base_local_planner", "base_local_planner/TrajectoryPlannerROS"),
            ("planner_frequency", 0.0, 0.0, 100.0),
            ("controller_frequency", 20.0, 0.0, 100.0),
            ("planner_patience", 5.0, 0.0, 100.0),
            ("max_planning_retries", -1.0, -1.0, 1000.0),
            ("conservative_reset_dist", 3.0, 0.0, 50.0),
            ("recovery_behavior_enabled", True),
            ("clearing_rotation_allowed", True),
            ("shutdown_costmaps", False),
            ("oscillation_timeout", 0.0, 0.0, 60.0),
            ("oscillation_distance", 0.5, 0.0, 10.0),
            ("make_plan_clear_costmap", True),
            ("make_plan_add_unreachable_goal", True),
        ],
    ),
    (
        "local_costmap",
        "costmap_2d/cfg/Costmap2D.cfg",
        {},
        [
            ("transform_tolerance", 0.3, 0.0, 10.0),
            ("update_frequency", 5.0, 0.0, 100.0),
            ("publish_frequency", 0.0, 0.0, 100.0),
            ("width", 10.0, 0.0, None),
            ("height", 10.0, 0.0, None),
            ("resolution", 0.05, 0.0, 50.0),
            ("origin_x", 0.0, None, None),
            ("origin_y", 0.0, None, None),
            ("footprint", "[]"),
            ("robot_radius", 0.46, 0.0, 10.0),
            ("footprint_padding", 0.01, None, None),
        ],
    ),
    (
        "local_costmap/obstacle_layer",
        "costmap_2d/cfg/ObstaclePlugin.cfg",
        {},
        [
            ("enabled", True),
            ("footprint_clearing_enabled", True),
            ("max_obstacle_height", 2.0, 0.0, 50.0),
            ("combination_method", 1.0, None, None),
        ],
    ),
    (
        "local_costmap/inflation_layer",
        "costmap_2d/cfg/InflationPlugin.cfg",
        {},
        [
            ("enabled", True),
            ("cost_scaling_factor", 10.0, 0.0, 100.0),
            ("inflation_radius", 0.55, 0.0, 50.0),
            ("inflate_unknown", False),
        ],
    ),
    (
        "local_costmap/obstacle_layer",
        "costmap_2d/cfg/VoxelPlugin.cfg",
        {"local_costmap": {"map_type": "voxel"}},
        [
            ("origin_z", 0.0, 0.0, None),
            ("z_resolution", 0.2, 0.0, 50.0),
            ("z_voxels", 10.0, 0.0, 16.0),
            ("unknown_threshold", 15.0, 0.0, 16.0),
            ("mark_threshold", 0.0, 0.0, 16.0),
        ],
    ),
    (
        "DWAPlannerROS",
        "dwa_local_planner/cfg/DWAPlanner.cfg",
        DWA,
        [
            ("max_vel_trans", 0.55, 0.0, None),
            ("min_vel_trans", 0.1, 0.0, None),
            ("max_vel_x", 0.55, None, None),
            ("min_vel_x", 0.0, None, None),
            ("max_vel_y", 0.1, None, None),
            ("min_vel_y", -0.1, None, None),
            ("max_vel_theta", 1.0, 0.0, None),
            ("min_vel_theta", 0.4, 0.0, None),
            ("acc_lim_x", 2.5, 0.0, 20.0),
            ("acc_lim_y", 2.5, 0.0, 20.0),
            ("acc_lim_theta", 3.2, 0.0, 20.0),
            ("prune_plan", False),
            ("sim_time", 1.7, 0.0, None),
            ("sim_granularity", 0.025, 0.0, None),
            ("angular_sim_granularity", 0.1, 0.0, None),
            ("path_distance_bias", 0.6, 0.0, None),
            ("goal_distance_bias", 0.8, 0.0, None),
            ("occdist_scale", 0.01, 0.0, None),
            ("twirling_scale", 0.0, 0.0, None),
            ("stop_time_buffer", 0.2, 0.0, None),
            ("oscillation_reset_dist", 0.05, 0.0, None),
            ("oscillation_reset_angle", 0.2, 0.0, None),
            ("forward_point_distance", 0.325, None, None),
            ("scaling_speed", 0.25, 0.0, None),
            ("max_scaling_factor", 0.2, 0.0, None),
            ("vx_samples", 3.0, 1.0, None),
            ("vy_samples", 10.0, 1.0, None),
            ("vth_samples", 20.0, 1.0, None),
            ("use_dwa", True),
        ],
    ),
    (
        "GlobalPlanner",
        "global_planner/cfg/GlobalPlanner.cfg",
        GLOBAL_PLANNER,
        [
            ("lethal_cost", 253.0, 1.0, 255.0),
            ("neutral_cost", 50.0, 1.0, 255.0),
            ("cost_factor", 3.0, 0.01, 5.0),
            ("publish_potential", True),
            ("orientation_mode", 1.0, 0.0, 6.0),
            ("orientation_window_size", 1.0, 1.0, 255.0),
        ],
    ),
]


def _in_table(server: str, source: str, parameters: Dict[str, Any], row: Tuple[Any, ...]) -> Case:
    name, expected = row[0], tuple(row[1:])
    words = f"{server.replace('/', ' ') or 'move_base'} offers {name} as its cfg file states"
    inputs = {"server": server, "name": name, "parameters": parameters}
    return Case(words.replace(" ", "_"), f"{source}: {name}", "parameters", inputs, expected)


PARAMETERS: List[Case] = [
    _in_table(server, source, parameters, row) for server, source, parameters, rows in TABLES for row in rows
]
PARAMETERS += [
    Case(
        f"DWAPlannerROS_offers_{name}_from_0_on",
        f"base_local_planner/src/local_planner_limits: {name} has no limits",
        "parameters",
        {"server": "DWAPlannerROS", "name": name, "parameters": DWA},
        (0.1, 0.0, None),
        official=(0.1, None, None),
        reason="with a negative value no goal is ever reached",
    )
    for name in ("xy_goal_tolerance", "yaw_goal_tolerance", "trans_stopped_vel", "theta_stopped_vel")
]
PARAMETERS += [
    Case(
        "controller_patience_is_15_s_unless_set",
        f"{MOVE_BASE_CPP}: private_nh.param",
        "parameters",
        {"server": "", "name": "controller_patience"},
        (15.0, 0.0, 100.0),
        official=(5.0, 0.0, 100.0),
        reason="the official server shows the default of its cfg file, 5 s, while its code uses 15 s",
    ),
    Case(
        "a_costmap_may_have_a_width_of_4_5_m",
        "costmap_2d/cfg/Costmap2D.cfg: width is a whole number",
        "parameters",
        {"server": "local_costmap", "name": "width", "parameters": {"local_costmap": {"width": 4.5}}},
        (4.5, 0.0, None),
        official=(5.0, 0.0, None),
        reason="the official costmap rounds to whole metres in silence",
    ),
    Case(
        "inflation_radius_of_the_costmap_is_shown_by_its_inflation_layer",
        "costmap_2d/src/costmap_2d_ros.cpp: copyParentParameters",
        "parameters",
        {
            "server": "local_costmap/inflation_layer",
            "name": "inflation_radius",
            "parameters": {"local_costmap": {"inflation_radius": 0.3}},
        },
        (0.3, 0.0, 50.0),
    ),
    Case(
        "a_robot_radius_above_the_costmaps_is_inherited",
        "costmap_2d/src/footprint.cpp: searchParam",
        "parameters",
        {"server": "local_costmap", "name": "robot_radius", "parameters": {"robot_radius": 0.2}},
        (0.2, 0.0, 10.0),
    ),
    Case(
        "each_layer_has_its_own_server",
        "costmap_2d/plugins/obstacle_layer.cpp: setupDynamicReconfigure",
        "parameters",
        {
            "server": "local_costmap/second",
            "name": "enabled",
            "parameters": {
                "local_costmap": {
                    "plugins": [
                        {"name": "first", "type": "costmap_2d::ObstacleLayer"},
                        {"name": "second", "type": "costmap_2d::ObstacleLayer"},
                    ],
                    "second": {"enabled": False},
                }
            },
        },
        (False,),
    ),
]

CLEAR, ROTATE = "clear_costmap_recovery/ClearCostmapRecovery", "rotate_recovery/RotateRecovery"
DEFAULTS = ["conservative_reset", "rotate_recovery", "aggressive_reset", "rotate_recovery_again"]


def _listed(*behaviors: Any) -> Dict[str, Any]:
    return {"parameters": {"recovery_behaviors": list(behaviors)}}


RECOVERIES: List[Case] = [
    Case(
        "by_default_a_robot_clears_rotates_clears_and_rotates",
        f"{MOVE_BASE_CPP}: loadDefaultRecoveryBehaviors",
        "recoveries",
        {"parameters": {}},
        DEFAULTS,
        official=[*DEFAULTS[:3], "rotate_recovery"],
        reason="names are unique here",
    ),
    Case(
        "without_clearing_rotation_allowed_it_only_clears",
        f"{MOVE_BASE_CPP}: clearing_rotation_allowed_",
        "recoveries",
        {"parameters": {"clearing_rotation_allowed": False}},
        ["conservative_reset", "aggressive_reset"],
    ),
    Case(
        "listed_behaviors_run_in_their_order",
        f"{MOVE_BASE_CPP}: loadRecoveryBehaviors",
        "recoveries",
        _listed({"name": "turn", "type": ROTATE}, {"name": "clear", "type": CLEAR}),
        ["turn", "clear"],
    ),
    Case(
        "a_type_without_its_package_is_found",
        f"{MOVE_BASE_CPP}: not fully qualified name",
        "recoveries",
        _listed({"name": "turn", "type": "RotateRecovery"}),
        ["turn"],
        official=[*DEFAULTS[:3], "rotate_recovery"],
        reason="the official search means to find it, but an inner loop hides its index",
    ),
    Case(
        "two_behaviors_of_one_name_are_replaced_by_the_default_ones",
        f"{MOVE_BASE_CPP}: already exists",
        "recoveries",
        _listed({"name": "a", "type": ROTATE}, {"name": "a", "type": CLEAR}),
        DEFAULTS,
        official=[*DEFAULTS[:3], "rotate_recovery"],
        reason="names are unique here",
    ),
    Case(
        "a_behavior_without_a_type_is_replaced_by_the_default_ones",
        f"{MOVE_BASE_CPP}: must have a name and a type",
        "recoveries",
        _listed({"name": "a"}),
        DEFAULTS,
        official=[*DEFAULTS[:3], "rotate_recovery"],
        reason="names are unique here",
    ),
    Case(
        "an_empty_list_means_no_behaviors",
        f"{MOVE_BASE_CPP}: behavior_list.size()",
        "recoveries",
        _listed(),
        [],
    ),
    Case(
        "an_unknown_type_is_refused",
        f"{MOVE_BASE_CPP}: Failed to load a plugin. Using default recovery behaviors",
        "recoveries",
        _listed({"name": "jump", "type": "jump/Jump"}),
        ["error: recovery_behaviors: jump has an unknown type 'jump/Jump'"],
        official=[*DEFAULTS[:3], "rotate_recovery"],
        reason="a robot does not start with other behaviors than its file lists",
    ),
]

ROOM = "\n".join(20 * [20 * "."])
WALLED = "\n".join([20 * "."] * 8 + [15 * "#" + 5 * "."] + [20 * "."] * 11)
CLOSED = "\n".join([20 * "."] * 8 + [20 * "#"] + [20 * "."] * 11)
FOG = "\n".join([20 * "."] * 8 + [20 * "?"] * 3 + [20 * "."] * 9)
LEFT, ABOVE = (1.0, 1.0), (1.0, 4.0)


def _plan(name: str, source: str, expected: Any, **given: Any) -> Case:
    differs = {key: given.pop(key) for key in ("official", "reason") if key in given}
    inputs = {"map": ROOM, "start": LEFT, "goal": ABOVE, **given}
    return Case(name, source, "plans", inputs, expected, **differs)


NAVFN_CPP, PLANNER_CPP = "navfn/src/navfn_ros.cpp", "global_planner/src/planner_core.cpp"
STRAIGHT = {"found": True, "end": ABOVE, "crosses": False, "is_detour": False}
PLANS: List[Case] = [
    _plan("a_plan_ends_at_the_goal", f"{NAVFN_CPP}: makePlan", STRAIGHT),
    _plan(
        "a_plan_leads_around_walls",
        f"{NAVFN_CPP}: makePlan",
        {"found": True, "end": ABOVE, "crosses": False, "is_detour": True},
        map=WALLED,
    ),
    _plan("there_is_no_plan_through_a_wall", f"{NAVFN_CPP}: makePlan", {"found": False}, map=CLOSED),
    _plan(
        "unknown_space_is_passable_by_default",
        f"{NAVFN_CPP}: allow_unknown true",
        STRAIGHT,
        map=FOG,
        global_costmap={"track_unknown_space": True},
    ),
    _plan(
        "unknown_space_is_impassable_without_allow_unknown",
        f"{NAVFN_CPP}: allow_unknown",
        {"found": False},
        map=FOG,
        global_costmap={"track_unknown_space": True},
        parameters={"NavfnROS": {"allow_unknown": False}},
    ),
    _plan(
        "unknown_space_is_free_without_track_unknown_space",
        "costmap_2d/src/costmap_2d_ros.cpp: copyParentParameters",
        STRAIGHT,
        map=FOG,
        global_costmap={"track_unknown_space": False},
        parameters={"NavfnROS": {"allow_unknown": False}},
    ),
    _plan(
        "there_is_no_plan_to_a_goal_in_a_wall",
        f"{NAVFN_CPP}: default_tolerance 0",
        {"found": False},
        map=WALLED,
        goal=(1.0, 2.85),
    ),
    _plan(
        "there_is_no_plan_to_a_goal_outside_the_map",
        f"{NAVFN_CPP}: The goal sent to the navfn planner is off the global costmap",
        {"found": False},
        goal=(9.0, 1.0),
    ),
    _plan(
        "there_is_no_plan_from_a_start_outside_the_map",
        f"{NAVFN_CPP}: The robot's start position is off the global costmap",
        {"found": False},
        start=(-1.0, 1.0),
    ),
    _plan(
        "global_planner_finds_the_same_way",
        f"{PLANNER_CPP}: makePlan",
        {"found": True, "end": ABOVE, "crosses": False, "is_detour": True},
        map=WALLED,
        parameters=GLOBAL_PLANNER,
    ),
    _plan(
        "global_planner_finds_a_way_with_a_star",
        f"{PLANNER_CPP}: use_dijkstra",
        {"found": True, "end": ABOVE, "crosses": False, "is_detour": True},
        map=WALLED,
        parameters={**GLOBAL_PLANNER, "GlobalPlanner": {"use_dijkstra": False}},
    ),
    _plan(
        "global_planner_passes_unknown_space_by_default",
        f"{PLANNER_CPP}: allow_unknown true",
        STRAIGHT,
        map=FOG,
        global_costmap={"track_unknown_space": True},
        parameters=GLOBAL_PLANNER,
    ),
    _plan(
        "global_planner_does_not_pass_unknown_space_without_allow_unknown",
        f"{PLANNER_CPP}: allow_unknown",
        {"found": False},
        map=FOG,
        global_costmap={"track_unknown_space": True},
        parameters={**GLOBAL_PLANNER, "GlobalPlanner": {"allow_unknown": False}},
    ),
]

CASES: List[Case] = [*PARAMETERS, *RECOVERIES, *PLANS]


def _ours(name: str) -> Any:
    def run(given: Any) -> Any:
        import move_base_rig

        return getattr(move_base_rig, name)(given)

    return run


def _official(name: str) -> Any:
    def run(given: Any) -> Any:
        import move_base_official  # imports ROS

        return getattr(move_base_official, name)(given)

    return run


RIGS: Dict[str, Rig] = {
    "parameters": Rig(
        _ours("parameters_of_ours"), _official("parameters_of_official"), ("move_base/move_base",)
    ),
    "recoveries": Rig(
        _ours("recoveries_of_ours"), _official("recoveries_of_official"), ("move_base/move_base",)
    ),
    "plans": Rig(_ours("plan_of_ours"), _official("plan_of_official"), ("move_base/move_base",)),
}
