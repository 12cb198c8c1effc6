"""Parameters of global and local planners."""

from typing import Sequence

from move_base_lite.control import ControllerSettings, DwaSettings, MppiSettings
from move_base_lite.parameters.reader import Reader, below, renamed
from move_base_lite.planning import PlannerSettings

GLOBAL_PLANNERS = ("navfn/NavfnROS", "global_planner/GlobalPlanner")
LOCAL_PLANNERS = (
    "base_local_planner/TrajectoryPlannerROS",
    "dwa_local_planner/DWAPlannerROS",
    "move_base_lite/MppiPlannerROS",
)

# Parameters that are known but mean nothing here: of a robot that moves sideways, of details of the official
# code, or read by it and never used.
_DWA_IGNORED = {
    "max_vel_y", "min_vel_y", "acc_lim_y", "acc_lim_trans", "vy_samples", "stop_time_buffer",
    "global_frame_id", "sum_scores", "odom_topic", "holonomic_robot", "restore_defaults", "prune_plan",
    "scaling_speed", "max_scaling_factor", "oscillation_reset_dist", "oscillation_reset_angle",
    "controller_frequency", "penalize_negative_x",
}  # fmt: skip
_TRAJECTORY_IGNORED = _DWA_IGNORED | {
    "escape_vel", "y_vels", "heading_scoring", "heading_scoring_timestep", "meter_scoring",
    "escape_reset_dist", "escape_reset_theta", "max_vel_y", "simple_attractor", "world_model",
    "backup_vel", "min_vel_theta",
}  # fmt: skip
_PLANNER_IGNORED = {
    "planner_window_x", "planner_window_y", "publish_potential", "outline_map", "old_navfn_behavior",
    "use_quadratic", "orientation_window_size", "restore_defaults",
}  # fmt: skip
_DWA_DEPRECATED = {
    "max_trans_vel": "max_vel_trans",
    "min_trans_vel": "min_vel_trans",
    "max_rot_vel": "max_vel_theta",
    "min_rot_vel": "min_vel_theta",
    "rot_stopped_vel": "theta_stopped_vel",
    "acc_limit_trans": "acc_lim_trans",
    "acc_lim_th": "acc_lim_theta",
    "vtheta_samples": "vth_samples",
}
_TRAJECTORY_NAMES = {
    "max_rotational_vel": "max_vel_theta",
    "min_in_place_vel_theta": "min_vel_theta",
    "min_in_place_rotational_vel": "min_vel_theta",
    "acc_lim_th": "acc_lim_theta",
    "vtheta_samples": "vth_samples",
    "pdist_scale": "path_distance_bias",
    "gdist_scale": "goal_distance_bias",
    "heading_lookahead": "forward_point_distance",
    "dwa": "use_dwa",
}
OLD_NAMES = (*_DWA_DEPRECATED.items(), *_TRAJECTORY_NAMES.items())
_TRAJECTORY_DEFAULTS = {
    "max_vel_x": 0.5,
    "min_vel_x": 0.1,
    "min_in_place_vel_theta": 0.4,
    "yaw_goal_tolerance": 0.05,
    "sim_time": 1.0,
    "publish_cost_grid_pc": True,
}


def controller_settings(reader: Reader, parameters) -> ControllerSettings:
    namespace = _planner_namespace(reader, parameters, "local", LOCAL_PLANNERS)
    values = dict(below(parameters, namespace))
    if "latch_xy_goal_tolerance" in parameters:
        values.setdefault("latch_xy_goal_tolerance", parameters["latch_xy_goal_tolerance"])
    if namespace == "MppiPlannerROS":
        return reader.read(MppiSettings, values, namespace + "/")
    if namespace == "TrajectoryPlannerROS":
        values = renamed({**_TRAJECTORY_DEFAULTS, **values}, _TRAJECTORY_NAMES)
        values["max_vel_trans"] = values["max_vel_x"]
        return reader.read(DwaSettings, values, namespace + "/", _TRAJECTORY_IGNORED)
    for old, new in _DWA_DEPRECATED.items():
        if old in values:
            reader.warnings.append(
                f"parameter {reader.where}DWAPlannerROS/{old} is deprecated, use {new} instead"
            )
            values.setdefault(new, values.pop(old))
    return reader.read(DwaSettings, values, namespace + "/", _DWA_IGNORED)


def planner_settings(reader: Reader, parameters) -> PlannerSettings:
    namespace = _planner_namespace(reader, parameters, "global", GLOBAL_PLANNERS)
    values = dict(below(parameters, namespace))
    if namespace == "GlobalPlanner":
        values = {"cost_factor": 3.0, "orientation_mode": 1, "publish_potential": True, **values}
        values = renamed(values, {"publish_potential": "visualize_potential"})
    if "use_dijkstra" in values:
        values["use_astar"] = not values.pop("use_dijkstra")
    return reader.read(PlannerSettings, values, namespace + "/", _PLANNER_IGNORED)


def _planner_namespace(reader: Reader, parameters, kind: str, known: Sequence[str]) -> str:
    """Where the parameters of the planner asked for stand; the first one known takes the place of others."""
    planner = str(parameters.get(f"base_{kind}_planner", known[0]))
    if planner not in known:
        reader.warnings.append(f"no {kind} planner {planner} here, {known[0]} takes its place")
        planner = known[0]
    return planner.rpartition("/")[2]
