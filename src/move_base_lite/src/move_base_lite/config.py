"""All settings of the Navigator, and the official parameters they come from."""

from dataclasses import dataclass, field, fields, replace
from typing import Any, Dict, List, Mapping, Tuple

import yaml

from move_base_lite.control import ControllerSettings, DwaSettings, MppiSettings
from move_base_lite.costmap import CostmapSettings, footprint_from
from move_base_lite.costmap.inflation import InflationSettings
from move_base_lite.costmap.obstacle_layer import ObstacleSettings
from move_base_lite.costmap.static_layer import StaticSettings
from move_base_lite.planning import PlannerSettings
from move_base_lite.recovery import RecoverySettings, RotateSettings, recovery_from
from planar import SettingsError
from planar.settings import check, settings_from

GLOBAL_PLANNERS = ("navfn/NavfnROS", "global_planner/GlobalPlanner")
LOCAL_PLANNERS = (
    "dwa_local_planner/DWAPlannerROS",
    "base_local_planner/TrajectoryPlannerROS",
    "move_base_lite/MppiPlannerROS",
)


@dataclass(frozen=True)
class MoveBaseSettings:
    """move_base's own parameters: Hz, seconds, metres. ``sensor_patience``: seconds after which a robot
    whose scans have stopped gives up its goal."""

    controller_frequency: float = 20.0
    planner_frequency: float = 0.0
    planner_patience: float = 5.0
    controller_patience: float = 15.0
    max_planning_retries: int = -1
    oscillation_timeout: float = 0.0
    oscillation_distance: float = 0.5
    conservative_reset_dist: float = 3.0
    clearing_rotation_allowed: bool = True
    recovery_behavior_enabled: bool = True
    make_plan_clear_costmap: bool = True
    make_plan_add_unreachable_goal: bool = True
    sensor_patience: float = 10.0

    def __post_init__(self):
        check(self.controller_frequency > 0.0, "controller_frequency", "positive", self.controller_frequency)
        for name in (
            "planner_frequency",
            "planner_patience",
            "controller_patience",
            "oscillation_timeout",
            "oscillation_distance",
            "sensor_patience",
        ):
            check(getattr(self, name) >= 0.0, name, "at least 0", getattr(self, name))


@dataclass(frozen=True)
class NavigatorSettings:
    """Everything the Navigator needs to know."""

    move_base: MoveBaseSettings = field(default_factory=MoveBaseSettings)
    planner: PlannerSettings = field(default_factory=PlannerSettings)
    controller: ControllerSettings = field(default_factory=DwaSettings)
    global_costmap: CostmapSettings = field(default_factory=CostmapSettings)
    local_costmap: CostmapSettings = field(default_factory=CostmapSettings)
    recoveries: Tuple[RecoverySettings, ...] = ()


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
    move_base = reader.read(MoveBaseSettings, parameters, "", ignore=_MOVE_BASE_IGNORED)
    controller = _controller_settings(reader, parameters, move_base)
    costmaps = {
        name: _costmap_settings(reader, _below(parameters, name), name, parameters)
        for name in ("global_costmap", "local_costmap")
    }
    settings = NavigatorSettings(
        move_base=move_base,
        planner=_planner_settings(reader, parameters),
        controller=controller,
        recoveries=_recoveries(reader, parameters, move_base, costmaps["local_costmap"]),
        **costmaps,
    )
    return settings, reader.warnings


class _Reader:
    """Reads dataclasses out of nested dictionaries and collects what is odd."""

    def __init__(self, where: str):
        self.where = where
        self.warnings: List[str] = []

    def read(self, kind, values: Mapping[str, Any], prefix: str, names: Mapping[str, str] = {}, ignore=()):
        flat = {
            name: value
            for name, value in values.items()
            if not isinstance(value, dict) and name not in ignore
        }
        settings, unknown = settings_from(kind, flat, names, self.where + prefix)
        self.warnings += [f"unknown parameter {self.where}{prefix}{name}" for name in unknown]
        return settings


_MOVE_BASE_IGNORED = {
    "base_global_planner",
    "base_local_planner",
    "recovery_behaviors",
    "latch_xy_goal_tolerance",
    "shutdown_costmaps",
    "clearing_radius",
    "restore_defaults",
    "strict_params",
    "footprint",
    "robot_radius",
    "footprint_padding",
    "obstacle_range",
    "raytrace_range",
}

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
_DWA_IGNORED = {
    "max_vel_y",
    "min_vel_y",
    "acc_lim_y",
    "acc_lim_trans",
    "vy_samples",
    "stop_time_buffer",
    "global_frame_id",
    "publish_traj_pc",
    "publish_cost_grid_pc",
    "sum_scores",
    "odom_topic",
    "holonomic_robot",
    "restore_defaults",
    "prune_plan",
    "scaling_speed",
    "max_scaling_factor",
    "oscillation_reset_dist",
    "oscillation_reset_angle",
}


def _controller_settings(reader: _Reader, parameters, move_base: MoveBaseSettings) -> ControllerSettings:
    planner = str(parameters.get("base_local_planner", LOCAL_PLANNERS[0]))
    if planner == LOCAL_PLANNERS[2]:
        return reader.read(MppiSettings, _below(parameters, "MppiPlannerROS"), "MppiPlannerROS/")
    values = dict(_below(parameters, "DWAPlannerROS"))
    for old, new in _DWA_DEPRECATED.items():
        if old in values:
            reader.warnings.append(
                f"parameter {reader.where}DWAPlannerROS/{old} is deprecated, use {new} instead"
            )
            values.setdefault(new, values.pop(old))
    if "latch_xy_goal_tolerance" in parameters:
        values.setdefault("latch_xy_goal_tolerance", parameters["latch_xy_goal_tolerance"])
    if planner not in LOCAL_PLANNERS:
        reader.warnings.append(f"no local planner {planner} here, {LOCAL_PLANNERS[0]} takes its place")
    return reader.read(DwaSettings, values, "DWAPlannerROS/", ignore=_DWA_IGNORED)


def _planner_settings(reader: _Reader, parameters) -> PlannerSettings:
    planner = str(parameters.get("base_global_planner", GLOBAL_PLANNERS[0]))
    if planner not in GLOBAL_PLANNERS:
        reader.warnings.append(f"no global planner {planner} here, {GLOBAL_PLANNERS[0]} takes its place")
        planner = GLOBAL_PLANNERS[0]
    namespace = planner.rpartition("/")[2]
    values = dict(_below(parameters, namespace))
    if "use_dijkstra" in values:
        values["use_astar"] = not values.pop("use_dijkstra")
    known = {item.name for item in fields(PlannerSettings)}
    return reader.read(PlannerSettings, {k: v for k, v in values.items() if k in known}, namespace + "/")


_LAYERS = {
    "StaticLayer": "static",
    "ObstacleLayer": "obstacles",
    "VoxelLayer": "obstacles",
    "InflationLayer": "inflation",
}
_COSTMAP_IGNORED = {
    "plugins",
    "static_map",
    "map_type",
    "observation_sources",
    "inscribed_radius",
    "circumscribed_radius",
    "footprint_topic",
    "published_footprint_topic",
}
_LAYER_KEYS = {
    "static": {item.name for item in fields(StaticSettings)} | {"first_map_only", "subscribe_to_updates"},
    "obstacles": {item.name for item in fields(ObstacleSettings)}
    | {"max_obstacle_height", "combination_method"},
    "inflation": {item.name for item in fields(InflationSettings)},
}
_OBSTACLE_IGNORED = {
    "observation_sources",
    "max_obstacle_height",
    "min_obstacle_height",
    "combination_method",
    "track_unknown_space",
    "transform_tolerance",
    "sensor_frame",
    "data_type",
    "observation_persistence",
    "origin_z",
    "z_resolution",
    "z_voxels",
    "unknown_threshold",
    "mark_threshold",
    "publish_voxel_map",
}


def _costmap_settings(reader: _Reader, values, name: str, parameters) -> CostmapSettings:
    values = dict(values)
    for inherited in ("footprint", "robot_radius", "footprint_padding"):
        if inherited in parameters:
            values.setdefault(inherited, parameters[inherited])
    if "footprint" in values:
        values["footprint"] = _corners(values["footprint"], f"{reader.where}{name}/footprint")
    layers = _layers_of(reader, values, name)
    own = {
        key: value
        for key, value in values.items()
        if key not in _COSTMAP_IGNORED and key in {item.name for item in fields(CostmapSettings)}
    }
    settings = reader.read(CostmapSettings, own, name + "/")
    known = set(own) | _COSTMAP_IGNORED | set().union(*_LAYER_KEYS.values())
    reader.warnings += [
        f"unknown parameter {reader.where}{name}/{key}"
        for key, value in values.items()
        if key not in known and not isinstance(value, dict)
    ]
    static = StaticSettings(enabled=False)
    obstacles = ObstacleSettings(enabled=False)
    inflation = InflationSettings(enabled=False)
    for kind, (prefix, tree) in layers.items():
        where = f"{name}/{prefix}"
        if kind == "static":
            static = reader.read(
                StaticSettings, tree, where, ignore={"first_map_only", "subscribe_to_updates"}
            )
        elif kind == "obstacles":
            obstacles = _obstacle_settings(reader, tree, where, parameters)
        else:
            inflation = reader.read(InflationSettings, tree, where)
    return replace(settings, static=static, obstacles=obstacles, inflation=inflation)


def _layers_of(reader: _Reader, values, name: str) -> Dict[str, Tuple[str, Mapping[str, Any]]]:
    """For each kind of layer the prefix and tree of its parameters; without plugins, those of old."""
    plugins = values.get("plugins")
    if plugins is None:
        kinds = ["obstacles", "inflation"] + (["static"] if values.get("static_map") else [])
        trees = {
            kind: {
                key: value
                for key, value in values.items()
                if key in _LAYER_KEYS[kind] or (kind == "obstacles" and isinstance(value, dict))
            }
            for kind in kinds
        }
        if "obstacles" in trees and "observation_sources" in values:
            trees["obstacles"]["observation_sources"] = values["observation_sources"]
        return {kind: ("", trees[kind]) for kind in kinds}
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


def _obstacle_settings(reader: _Reader, tree, where: str, parameters) -> ObstacleSettings:
    """The layer's own parameters and those of its first source that is a laser scan."""
    merged = {key: value for key, value in tree.items() if not isinstance(value, dict)}
    for inherited in ("obstacle_range", "raytrace_range"):
        if inherited in parameters:
            merged.setdefault(inherited, parameters[inherited])
    sources = str(tree.get("observation_sources", "")).split()
    scans = [
        source for source in sources if _below(tree, source).get("data_type", "LaserScan") == "LaserScan"
    ]
    for source in sources:
        if source not in scans[:1]:
            reader.warnings.append(f"{reader.where}{where}{source}: only one laser scan is listened to")
    if scans:
        merged = {"topic": scans[0], **merged, **_below(tree, scans[0])}
        where += scans[0] + "/"
    elif "enabled" not in merged:
        merged["enabled"] = False
    return reader.read(ObstacleSettings, merged, where, ignore=_OBSTACLE_IGNORED)


def _corners(value: Any, name: str) -> Tuple[Tuple[float, float], ...]:
    try:
        points = yaml.safe_load(value) if isinstance(value, str) else value
        return tuple((float(x), float(y)) for x, y in points)
    except (yaml.YAMLError, TypeError, ValueError):
        raise SettingsError(f"{name} must be a list of points [x, y], got {value!r}") from None


_ROTATE_NAMES = {
    "acc_lim_th": "acc_lim_theta",
    "max_rotational_vel": "max_vel_theta",
    "min_in_place_rotational_vel": "min_in_place_vel_theta",
}


def _recoveries(
    reader: _Reader, parameters, move_base: MoveBaseSettings, local: CostmapSettings
) -> Tuple[RecoverySettings, ...]:
    rotating = {
        _ROTATE_NAMES.get(key, key): value
        for key, value in _below(parameters, "TrajectoryPlannerROS").items()
    }
    known = {item.name for item in fields(RotateSettings)}
    rotate = reader.read(
        RotateSettings, {k: v for k, v in rotating.items() if k in known}, "TrajectoryPlannerROS/"
    )
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
        own = _below(parameters, item["name"])
        recovery = RecoverySettings(
            name=item["name"],
            type=str(item["type"]),
            reset_distance=float(own.get("reset_distance", distances.get(item["name"], 3.0))),
            affected_maps=str(own.get("affected_maps", "both")),
            rotate=rotate,
        )
        recovery_from(recovery)
        recoveries.append(recovery)
    return tuple(recoveries)


def _default_recoveries(rotation_allowed: bool) -> List[Dict[str, str]]:
    clear, rotate = "clear_costmap_recovery/ClearCostmapRecovery", "rotate_recovery/RotateRecovery"
    order = [("conservative_reset", clear), ("rotate_recovery", rotate), ("aggressive_reset", clear)]
    order.append(("rotate_recovery_again", rotate))
    return [{"name": name, "type": kind} for name, kind in order if rotation_allowed or kind != rotate]


def _below(parameters: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    value = parameters.get(name, {})
    return value if isinstance(value, dict) else {}
