"""move_base's parameters, as a nested dictionary, made into the settings of a Navigator."""

from dataclasses import fields, replace
from typing import Any, Dict, Iterable, List, Mapping, Tuple

import yaml

from move_base_lite.config import MoveBaseSettings, NavigatorSettings
from move_base_lite.control import ControllerSettings, DwaSettings, MppiSettings
from move_base_lite.costmap import CostmapSettings, footprint_from
from move_base_lite.costmap.inflation import InflationSettings
from move_base_lite.costmap.obstacle_layer import ObstacleSettings, SourceSettings
from move_base_lite.costmap.static_layer import StaticSettings
from move_base_lite.planning import PlannerSettings
from move_base_lite.recovery import RecoverySettings, RotateSettings, SlowSettings, recovery_from
from planar import SettingsError
from planar.settings import nearest_name, settings_from

GLOBAL_PLANNERS = ("navfn/NavfnROS", "global_planner/GlobalPlanner")
LOCAL_PLANNERS = (
    "base_local_planner/TrajectoryPlannerROS",
    "dwa_local_planner/DWAPlannerROS",
    "move_base_lite/MppiPlannerROS",
)

# Parameters that are known but mean nothing here: of a robot that moves sideways, of details of the official
# code, or read by it and never used.
_MOVE_BASE_IGNORED = {
    "base_global_planner", "base_local_planner", "recovery_behaviors", "latch_xy_goal_tolerance",
    "restore_defaults", "strict_params", "footprint", "robot_radius", "footprint_padding", "obstacle_range",
    "raytrace_range", "actionlib_status_frequency", "status_list_timeout",
}  # fmt: skip
_DWA_IGNORED = {
    "max_vel_y", "min_vel_y", "acc_lim_y", "acc_lim_trans", "vy_samples", "stop_time_buffer",
    "global_frame_id", "publish_traj_pc", "publish_cost_grid_pc", "sum_scores", "odom_topic",
    "holonomic_robot", "restore_defaults", "prune_plan", "scaling_speed", "max_scaling_factor",
    "oscillation_reset_dist", "oscillation_reset_angle", "controller_frequency", "penalize_negative_x",
}  # fmt: skip
_TRAJECTORY_IGNORED = _DWA_IGNORED | {
    "escape_vel", "y_vels", "heading_scoring", "heading_scoring_timestep", "meter_scoring",
    "escape_reset_dist", "escape_reset_theta", "max_vel_y", "simple_attractor", "world_model",
    "backup_vel", "min_vel_theta",
}  # fmt: skip
_PLANNER_IGNORED = {
    "planner_window_x", "planner_window_y", "visualize_potential", "publish_scale", "publish_potential",
    "outline_map", "old_navfn_behavior", "use_quadratic", "orientation_window_size", "restore_defaults",
}  # fmt: skip
_COSTMAP_IGNORED = {
    "plugins", "static_map", "map_type", "observation_sources", "inscribed_radius", "circumscribed_radius",
    "footprint_topic", "published_footprint_topic", "restore_defaults",
}  # fmt: skip
_VOXELS_IGNORED = {
    "origin_z", "z_resolution", "z_voxels", "unknown_threshold", "mark_threshold", "publish_voxel_map",
}  # fmt: skip
_STATIC_IGNORED = {"first_map_only", "subscribe_to_updates", "use_maximum"}
_OBSTACLE_IGNORED = {
    "observation_sources", "track_unknown_space", "transform_tolerance", "obstacle_range", "raytrace_range",
} | _VOXELS_IGNORED  # fmt: skip

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
_TRAJECTORY_DEFAULTS = {
    "max_vel_x": 0.5,
    "min_vel_x": 0.1,
    "min_in_place_vel_theta": 0.4,
    "yaw_goal_tolerance": 0.05,
    "sim_time": 1.0,
}
_ROTATE_NAMES = {
    "acc_lim_th": "acc_lim_theta",
    "max_rotational_vel": "max_vel_theta",
    "min_in_place_rotational_vel": "min_in_place_vel_theta",
}
_LAYERS = {
    "StaticLayer": "static",
    "ObstacleLayer": "obstacles",
    "VoxelLayer": "obstacles",
    "InflationLayer": "inflation",
}


def load_settings(path) -> NavigatorSettings:
    """Settings from a YAML file of official parameters, as ``rosparam load`` would read it."""
    with open(path, encoding="utf-8") as file:  # noqa: PTH123
        parameters = yaml.safe_load(file)
    return settings_from_parameters(parameters, str(path) + ": ")[0]


def settings_from_parameters(
    parameters: Mapping[str, Any], where: str = ""
) -> Tuple[NavigatorSettings, List[str]]:
    """Settings from move_base's parameters as a nested dictionary, and warnings for people.

    Raises SettingsError with the full name of the parameter, ``where`` put before it.
    """
    reader = _Reader(where)
    move_base = reader.read(MoveBaseSettings, parameters, "", _MOVE_BASE_IGNORED)
    costmaps = {
        name: _costmap_settings(reader, _below(parameters, name), name, parameters)
        for name in ("global_costmap", "local_costmap")
    }
    settings = NavigatorSettings(
        move_base=move_base,
        planner=_planner_settings(reader, parameters),
        controller=_controller_settings(reader, parameters),
        recoveries=_recoveries(reader, parameters, move_base, costmaps["local_costmap"]),
        **costmaps,
    )
    return settings, reader.warnings


class _Reader:
    """Reads dataclasses out of nested dictionaries and collects what is odd."""

    def __init__(self, where: str):
        self.where = where
        self.warnings: List[str] = []

    def read(self, kind, values: Mapping[str, Any], prefix: str, ignore: Iterable[str] = ()):
        """The settings ``kind`` from the values that are not dictionaries themselves."""
        flat = {
            name: value
            for name, value in values.items()
            if not isinstance(value, dict) and name not in ignore
        }
        settings, unknown = settings_from(kind, flat, where=self.where + prefix)
        self.report_unknown(unknown, prefix, [*_names_of(kind), *ignore])
        return settings

    def report_unknown(self, names: Iterable[str], prefix: str, known: Iterable[str]) -> None:
        known = list(known)
        for name in names:
            nearest = nearest_name(name, known)
            hint = f", did you mean {nearest}?" if nearest else ""
            self.warnings.append(f"unknown parameter {self.where}{prefix}{name}{hint}")


def _controller_settings(reader: _Reader, parameters) -> ControllerSettings:
    planner = str(parameters.get("base_local_planner", LOCAL_PLANNERS[0]))
    if planner not in LOCAL_PLANNERS:
        reader.warnings.append(f"no local planner {planner} here, {LOCAL_PLANNERS[0]} takes its place")
        planner = LOCAL_PLANNERS[0]
    namespace = planner.rpartition("/")[2]
    values = dict(_below(parameters, namespace))
    if "latch_xy_goal_tolerance" in parameters:
        values.setdefault("latch_xy_goal_tolerance", parameters["latch_xy_goal_tolerance"])
    if namespace == "MppiPlannerROS":
        return reader.read(MppiSettings, values, namespace + "/")
    if namespace == "TrajectoryPlannerROS":
        values = _renamed({**_TRAJECTORY_DEFAULTS, **values}, _TRAJECTORY_NAMES)
        values["max_vel_trans"] = values["max_vel_x"]
        return reader.read(DwaSettings, values, namespace + "/", _TRAJECTORY_IGNORED)
    for old, new in _DWA_DEPRECATED.items():
        if old in values:
            reader.warnings.append(
                f"parameter {reader.where}DWAPlannerROS/{old} is deprecated, use {new} instead"
            )
            values.setdefault(new, values.pop(old))
    return reader.read(DwaSettings, values, namespace + "/", _DWA_IGNORED)


def _planner_settings(reader: _Reader, parameters) -> PlannerSettings:
    planner = str(parameters.get("base_global_planner", GLOBAL_PLANNERS[0]))
    if planner not in GLOBAL_PLANNERS:
        reader.warnings.append(f"no global planner {planner} here, {GLOBAL_PLANNERS[0]} takes its place")
        planner = GLOBAL_PLANNERS[0]
    namespace = planner.rpartition("/")[2]
    values = dict(_below(parameters, namespace))
    if namespace == "GlobalPlanner":
        values = {"cost_factor": 3.0, "orientation_mode": 1, **values}
    if "use_dijkstra" in values:
        values["use_astar"] = not values.pop("use_dijkstra")
    return reader.read(PlannerSettings, values, namespace + "/", _PLANNER_IGNORED)


def _costmap_settings(reader: _Reader, values, name: str, parameters) -> CostmapSettings:
    values = dict(values)
    for inherited in ("footprint", "robot_radius", "footprint_padding"):
        if inherited in parameters:
            values.setdefault(inherited, parameters[inherited])
    if "footprint" in values:
        values["footprint"] = _corners(values["footprint"], f"{reader.where}{name}/footprint")
    layers = _layers_of(reader, values, name)
    of_layers = set() if "plugins" in values else _PRE_PLUGINS
    settings = reader.read(CostmapSettings, values, name + "/", _COSTMAP_IGNORED | of_layers)
    static = StaticSettings(enabled=False)
    obstacles = ObstacleSettings(enabled=False)
    inflation = InflationSettings(enabled=False)
    for kind, (prefix, tree) in layers.items():
        where = f"{name}/{prefix}"
        if kind == "static":
            static = reader.read(StaticSettings, tree, where, _STATIC_IGNORED)
        elif kind == "obstacles":
            obstacles = _obstacle_settings(reader, tree, where, [values, parameters])
        else:
            inflation = reader.read(InflationSettings, tree, where)
    return replace(settings, static=static, obstacles=obstacles, inflation=inflation)


def _layers_of(reader: _Reader, values, name: str) -> Dict[str, Tuple[str, Mapping[str, Any]]]:
    """For each kind of layer the prefix and tree of its parameters; without plugins, those of old."""
    plugins = values.get("plugins")
    if plugins is None:
        kinds = ["obstacles", "inflation"] + (["static"] if values.get("static_map") else [])
        return {
            kind: (
                "",
                {
                    key: value
                    for key, value in values.items()
                    if key in _LAYER_KEYS[kind] or (kind == "obstacles" and isinstance(value, dict))
                },
            )
            for kind in kinds
        }
    layers = {}
    for plugin in plugins:
        if not isinstance(plugin, dict) or not {"name", "type"} <= set(plugin):
            raise SettingsError(
                f"{reader.where}{name}/plugins must be a list of {{name, type}}, got {plugin!r}"
            )
        kind = _LAYERS.get(str(plugin["type"]).rpartition("::")[2])
        if kind is None:
            reader.warnings.append(f"no layer of type {plugin['type']} here, {plugin['name']} is left out")
        else:
            layers[kind] = (f"{plugin['name']}/", _below(values, plugin["name"]))
    return layers


def _obstacle_settings(reader: _Reader, tree, where: str, outer: List[Mapping[str, Any]]) -> ObstacleSettings:
    """A layer with its sources; their ranges are searched for in the namespaces around them too."""
    layer = reader.read(ObstacleSettings, tree, where, _OBSTACLE_IGNORED)
    sources = []
    for name in str(tree.get("observation_sources", "")).split():
        own = {"topic": name, **_below(tree, name)}
        for key in ("obstacle_range", "raytrace_range"):
            for around in (tree, *outer):
                if key in around:
                    own.setdefault(key, around[key])
        sources.append(reader.read(SourceSettings, own, f"{where}{name}/"))
    return replace(layer, sources=tuple(sources))


def _recoveries(
    reader: _Reader, parameters, move_base: MoveBaseSettings, local: CostmapSettings
) -> Tuple[RecoverySettings, ...]:
    listed = parameters.get("recovery_behaviors")
    if listed is None:
        listed = _default_recoveries(move_base.clearing_rotation_allowed)
    names = [item["name"] for item in listed if isinstance(item, dict) and "name" in item and "type" in item]
    if len(names) != len(listed) or len(set(names)) != len(names):
        reader.warnings.append(
            f"{reader.where}recovery_behaviors must be a list of {{name, type}} with different names, "
            "the default ones take their place"
        )
        listed = _default_recoveries(move_base.clearing_rotation_allowed)
    footprint = footprint_from(local.footprint, local.robot_radius, local.footprint_padding)
    distances = {
        "conservative_reset": move_base.conservative_reset_dist,
        "aggressive_reset": 4.0 * footprint.circumscribed_radius,
    }
    recoveries = []
    for item in listed:
        name, kind = item["name"], str(item["type"])
        own = dict(_below(parameters, name))
        if name in distances and kind.endswith("ClearCostmapRecovery"):
            own.setdefault("reset_distance", distances[name])
        recoveries.append(_recovery(reader, parameters, name, kind, own))
    return tuple(recoveries)


def _recovery(reader: _Reader, parameters, name: str, kind: str, own: Mapping[str, Any]) -> RecoverySettings:
    rotating = _renamed(_below(parameters, "TrajectoryPlannerROS"), _ROTATE_NAMES)
    rotate = {key: value for key, value in rotating.items() if key in _names_of(RotateSettings)}
    where = f"{name}/"
    recovery = RecoverySettings(name, kind)
    if kind.endswith("ClearCostmapRecovery"):
        values = {"name": name, "type": kind, **own}
        recovery = reader.read(RecoverySettings, values, where)
    elif kind.endswith("RotateRecovery"):
        reader.report_unknown(set(own) - {"sim_granularity", "frequency"}, where, ["sim_granularity"])
        recovery = replace(recovery, rotate=reader.read(RotateSettings, rotate, "TrajectoryPlannerROS/"))
    elif kind.endswith("MoveSlowAndClear"):
        ignored = {"max_trans_param_name", "max_rot_param_name", "planner_namespace"}
        recovery = replace(recovery, slow=reader.read(SlowSettings, own, where, ignored))
    recovery_from(recovery)
    return recovery


def _default_recoveries(rotation_allowed: bool) -> List[Dict[str, str]]:
    clear, rotate = "clear_costmap_recovery/ClearCostmapRecovery", "rotate_recovery/RotateRecovery"
    order = [("conservative_reset", clear), ("rotate_recovery", rotate), ("aggressive_reset", clear)]
    order.append(("rotate_recovery_again", rotate))
    return [{"name": name, "type": kind} for name, kind in order if rotation_allowed or kind != rotate]


def _corners(value: Any, name: str) -> Tuple[Tuple[float, float], ...]:
    try:
        points = yaml.safe_load(value) if isinstance(value, str) else value
        return tuple((float(x), float(y)) for x, y in points)
    except (yaml.YAMLError, TypeError, ValueError):
        raise SettingsError(f"{name} must be a list of points [x, y], got {value!r}") from None


def _below(parameters: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    value = parameters.get(name, {})
    return value if isinstance(value, dict) else {}


def _renamed(values: Mapping[str, Any], names: Mapping[str, str]) -> Dict[str, Any]:
    return {names.get(name, name): value for name, value in values.items()}


def _names_of(kind) -> List[str]:
    return [item.name for item in fields(kind)]


_LAYER_KEYS = {
    "static": {*_names_of(StaticSettings), *_STATIC_IGNORED} - {"enabled"},
    "obstacles": {*_names_of(ObstacleSettings), *_OBSTACLE_IGNORED} - {"enabled", "sources"},
    "inflation": set(_names_of(InflationSettings)) - {"enabled"},
}
# What stood directly in a costmap's namespace before there were plugins.
_PRE_PLUGINS = set().union(*_LAYER_KEYS.values())
