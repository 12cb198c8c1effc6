"""What dynamic_reconfigure may change: the parameters that the official packages' .cfg files list."""

import dataclasses
import math
from typing import Any, Dict, List, Mapping, Tuple

from move_base_lite.control import MppiSettings
from move_base_lite.parameters.costmaps import layers_of, with_plugins
from move_base_lite.parameters.planners import OLD_NAMES
from move_base_lite.parameters.reader import Reader, below
from planar.config.parameters import Tunable

Tree = Mapping[str, Any]

_INHERITED = ("footprint", "robot_radius", "footprint_padding")
_MOVE_BASE = (
    Tunable("base_global_planner", "navfn/NavfnROS", "global planner"),
    Tunable("base_local_planner", "base_local_planner/TrajectoryPlannerROS", "local planner"),
    Tunable("planner_frequency", 0.0, "Hz, plans while driving; 0: only when need be", 0.0, 100.0),
    Tunable("controller_frequency", 20.0, "Hz, velocities", 0.0, 100.0),
    Tunable("planner_patience", 5.0, "s without a plan until recovery", 0.0, 100.0),
    Tunable("controller_patience", 15.0, "s without a velocity until recovery", 0.0, 100.0),
    Tunable("max_planning_retries", -1, "failed plans until recovery; -1: no limit", -1, 1000),
    Tunable("conservative_reset_dist", 3.0, "m kept by the first recovery", 0.0, 50.0),
    Tunable("recovery_behavior_enabled", True, "whether there are recoveries"),
    Tunable("clearing_rotation_allowed", True, "whether the default recoveries may rotate"),
    Tunable("shutdown_costmaps", False, "whether costmaps rest while there is no goal"),
    Tunable("oscillation_timeout", 0.0, "s without progress until recovery; 0: never", 0.0, 60.0),
    Tunable("oscillation_distance", 0.5, "m that count as progress", 0.0, 10.0),
    Tunable("make_plan_clear_costmap", True, "make_plan forgets obstacles around the robot"),
    Tunable("make_plan_add_unreachable_goal", True, "make_plan ends at the goal in any case"),
)
_COSTMAP = (
    Tunable("transform_tolerance", 0.3, "s, how old a transform may be", 0.0, 10.0),
    Tunable("update_frequency", 5.0, "Hz", 0.0, 100.0),
    Tunable("publish_frequency", 0.0, "Hz; 0: never but to new subscribers", 0.0, 100.0),
    Tunable("width", 10.0, "m, unless the map sets the size", 0.0),
    Tunable("height", 10.0, "m, unless the map sets the size", 0.0),
    Tunable("resolution", 0.05, "m per cell, unless the map sets it", 0.0, 50.0),
    Tunable("origin_x", 0.0, "m"),
    Tunable("origin_y", 0.0, "m"),
    Tunable("footprint", "[]", "corners [[x, y], ...] in m; empty: a circle"),
    Tunable("robot_radius", 0.46, "m", 0.0, 10.0),
    Tunable("footprint_padding", 0.01, "m"),
)
_ENABLED = Tunable("enabled", True, "whether the layer counts")
_OBSTACLES = (
    _ENABLED,
    Tunable("footprint_clearing_enabled", True, "where the robot stands is free"),
    Tunable("max_obstacle_height", 2.0, "m up to which anything marks", 0.0, 50.0),
    Tunable("combination_method", 1, "0 overwrites, 1 takes the higher cost, 99 nothing", 0, 99),
)
_VOXELS = (
    *_OBSTACLES,
    Tunable("origin_z", 0.0, "m (no effect: obstacles are flat)", 0.0),
    Tunable("z_resolution", 0.2, "m (no effect: obstacles are flat)", 0.0, 50.0),
    Tunable("z_voxels", 10, "count (no effect: obstacles are flat)", 0, 16),
    Tunable("unknown_threshold", 15, "count (no effect: obstacles are flat)", 0, 16),
    Tunable("mark_threshold", 0, "count (no effect: obstacles are flat)", 0, 16),
)
_INFLATION = (
    _ENABLED,
    Tunable("cost_scaling_factor", 10.0, "1/m, how fast costs fall", 0.0, 100.0),
    Tunable("inflation_radius", 0.55, "m", 0.0, 50.0),
    Tunable("inflate_unknown", False, "whether unknown cells are inflated too"),
)
_LAYERS: Dict[str, Tuple[Tunable, ...]] = {
    "StaticLayer": (_ENABLED,),
    "ObstacleLayer": _OBSTACLES,
    "VoxelLayer": _VOXELS,
    "InflationLayer": _INFLATION,
}
_LIMITS = (
    Tunable("max_vel_trans", 0.55, "m/s", 0.0),
    Tunable("min_vel_trans", 0.1, "m/s, slower the robot does not set off", 0.0),
    Tunable("max_vel_x", 0.55, "m/s"),
    Tunable("min_vel_x", 0.0, "m/s, negative: may drive backwards"),
    Tunable("max_vel_y", 0.1, "m/s (no effect on a differential drive)"),
    Tunable("min_vel_y", -0.1, "m/s (no effect on a differential drive)"),
    Tunable("max_vel_theta", 1.0, "rad/s", 0.0),
    Tunable("min_vel_theta", 0.4, "rad/s, slower the robot does not turn on the spot", 0.0),
    Tunable("acc_lim_x", 2.5, "m/s^2", 0.0, 20.0),
    Tunable("acc_lim_y", 2.5, "m/s^2 (no effect on a differential drive)", 0.0, 20.0),
    Tunable("acc_lim_theta", 3.2, "rad/s^2", 0.0, 20.0),
    Tunable("acc_lim_trans", 0.1, "m/s^2 (no effect on a differential drive)", 0.0, 20.0),
    Tunable("prune_plan", False, "(no effect: what lies behind the robot is always left out)"),
    Tunable("xy_goal_tolerance", 0.1, "m", 0.0),
    Tunable("yaw_goal_tolerance", 0.1, "rad", 0.0),
    Tunable("trans_stopped_vel", 0.1, "m/s below which the robot stands", 0.0),
    Tunable("theta_stopped_vel", 0.1, "rad/s below which the robot stands", 0.0),
)
_SAMPLING = (
    Tunable("sim_time", 1.7, "s that each velocity is followed ahead", 0.0),
    Tunable("sim_granularity", 0.025, "m between poses checked", 0.0),
    Tunable("path_distance_bias", 0.6, "weight of the distance to the plan", 0.0),
    Tunable("goal_distance_bias", 0.8, "weight of the distance to the plan's end", 0.0),
    Tunable("occdist_scale", 0.01, "weight of the costs under the footprint", 0.0),
    Tunable("stop_time_buffer", 0.2, "s (no effect)", 0.0),
    Tunable("oscillation_reset_dist", 0.05, "m (no effect: nothing oscillates)", 0.0),
)
_DWA = (
    *_LIMITS,
    *_SAMPLING,
    Tunable("angular_sim_granularity", 0.1, "rad between poses checked", 0.0),
    Tunable("twirling_scale", 0.0, "weight of turning", 0.0),
    Tunable("oscillation_reset_angle", 0.2, "rad (no effect: nothing oscillates)", 0.0),
    Tunable("forward_point_distance", 0.325, "m, nose that is to lie on the plan too"),
    Tunable("scaling_speed", 0.25, "m/s (no effect: the footprint is exact)", 0.0),
    Tunable("max_scaling_factor", 0.2, "(no effect: the footprint is exact)", 0.0),
    Tunable("vx_samples", 3, "count", 1),
    Tunable("vy_samples", 10, "count (no effect on a differential drive)", 1),
    Tunable("vth_samples", 20, "count", 1),
    Tunable("use_dwa", True, "velocities reachable in one period, or within sim_time"),
)
_TRAJECTORY = (
    Tunable("acc_lim_x", 2.5, "m/s^2", 0.0, 20.0),
    Tunable("acc_lim_y", 2.5, "m/s^2 (no effect on a differential drive)", 0.0, 20.0),
    Tunable("acc_lim_theta", 3.2, "rad/s^2", 0.0, 20.0),
    Tunable("max_vel_x", 0.5, "m/s", 0.0, 20.0),
    Tunable("min_vel_x", 0.1, "m/s", 0.0, 20.0),
    Tunable("max_vel_theta", 1.0, "rad/s", 0.0, 20.0),
    Tunable("min_in_place_vel_theta", 0.4, "rad/s", 0.0, 20.0),
    *_SAMPLING,
    Tunable("angular_sim_granularity", 0.025, "rad between poses checked", 0.0),
    Tunable("vx_samples", 3, "count", 1, 300),
    Tunable("vtheta_samples", 20, "count", 1, 300),
    Tunable("heading_lookahead", 0.325, "m, nose that is to lie on the plan too", 0.0, 5.0),
    Tunable("dwa", True, "velocities reachable in one period, or within sim_time"),
)
_GLOBAL_PLANNER = (
    Tunable("lethal_cost", 253, "cost from which on a cell cannot be entered", 1, 255),
    Tunable("neutral_cost", 50, "of entering a free cell", 1, 255),
    Tunable("cost_factor", 3.0, "how much a cell's cost adds to that", 0.01, 5.0),
    Tunable("publish_potential", True, "whether the wave of each plan is shown"),
    Tunable("orientation_mode", 1, "of the poses: 0 none ... 6 rightward", 0, 6),
    Tunable("orientation_window_size", 1, "(no effect)", 1, 255),
    Tunable("outline_map", True, "(no effect: the rim is always barred)"),
)
_PLANNERS: Dict[str, Tuple[Tunable, ...]] = {
    "MppiPlannerROS": tuple(
        Tunable(field.name, field.default, "as in config/move_base_lite.yaml")
        for field in dataclasses.fields(MppiSettings)
    ),
    "DWAPlannerROS": _DWA,
    "TrajectoryPlannerROS": _TRAJECTORY,
    "GlobalPlanner": _GLOBAL_PLANNER,
}


def servers(parameters: Tree) -> Dict[str, List[Tuple[Tunable, Any]]]:
    """By namespace below move_base: what may be changed there, with the values in force."""
    found: Dict[str, Tuple[Tunable, ...]] = {"": _MOVE_BASE}
    for costmap in ("global_costmap", "local_costmap"):
        found[costmap] = _COSTMAP
        values = with_plugins(below(parameters, costmap))
        for layer, kind in layers_of(Reader(""), values, costmap).items():
            found[f"{costmap}/{layer}"] = _LAYERS[kind]
    for key in ("base_global_planner", "base_local_planner"):
        planner = str(parameters.get(key, "TrajectoryPlannerROS")).rpartition("/")[2]
        found.update({planner: _PLANNERS[planner]} if planner in _PLANNERS else {})
    return {name: [(one, _value(parameters, name, one)) for one in all] for name, all in found.items()}


def changed(parameters: Tree, namespace: str, values: Mapping[str, Any]) -> Dict[str, Any]:
    """The parameters with other values in a namespace below move_base."""
    name, _, rest = namespace.partition("/")
    if not name:
        return {**parameters, **values}
    tree = below(parameters, name)
    if name.endswith("costmap"):
        tree = with_plugins(tree)
    return {**parameters, name: changed(tree, rest, values)}


def _value(parameters: Tree, namespace: str, tunable: Tunable) -> Any:
    """The value of a parameter, also if it is inherited or has an old name; of the type it has here."""
    trees = [parameters]
    for name in filter(None, namespace.split("/")):
        trees.append(
            with_plugins(below(trees[-1], name)) if name.endswith("costmap") else below(trees[-1], name)
        )
    old_names = [old for old, new in OLD_NAMES if new == tunable.name]
    found = next((trees[-1][name] for name in (tunable.name, *old_names) if name in trees[-1]), None)
    if found is None and tunable.name in _INHERITED:
        found = parameters.get(tunable.name)
    if found is None:
        return tunable.default
    if isinstance(tunable.default, str):
        return str(found)
    return math.inf if found == "inf" else type(tunable.default)(found)
