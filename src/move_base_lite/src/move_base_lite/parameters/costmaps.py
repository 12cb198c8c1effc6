"""Parameters of costmaps and their layers."""

from dataclasses import replace
from typing import Any, Dict, List, Mapping, Tuple

import yaml

from move_base_lite.costmap import CostmapSettings
from move_base_lite.costmap.inflation import InflationSettings
from move_base_lite.costmap.obstacle_layer import ObstacleSettings, SourceSettings
from move_base_lite.costmap.static_layer import StaticSettings
from move_base_lite.parameters.reader import Reader, below, names_of
from planar import SettingsError

# Parameters that are known but mean nothing here: of a robot that moves sideways, of details of the official
# code, or read by it and never used.
_COSTMAP_IGNORED = {
    "plugins", "static_map", "map_type", "inscribed_radius", "circumscribed_radius",
    "footprint_topic", "published_footprint_topic", "restore_defaults",
}  # fmt: skip
_VOXELS_IGNORED = {
    "origin_z", "z_resolution", "z_voxels", "unknown_threshold", "mark_threshold", "publish_voxel_map",
}  # fmt: skip
_STATIC_IGNORED = {"first_map_only", "subscribe_to_updates", "use_maximum"}
_OBSTACLE_IGNORED = {
    "observation_sources", "transform_tolerance", "obstacle_range", "raytrace_range",
} | _VOXELS_IGNORED  # fmt: skip

# What belongs to each kind of layer; it stood in the costmap's own namespace before there were plugins.
_OBSTACLE_KEYS = {*names_of(ObstacleSettings), *_OBSTACLE_IGNORED} - {"enabled", "sources"}
_LAYER_KEYS = {
    "StaticLayer": {*names_of(StaticSettings), *_STATIC_IGNORED} - {"enabled"},
    "ObstacleLayer": _OBSTACLE_KEYS,
    "VoxelLayer": _OBSTACLE_KEYS,
    "InflationLayer": set(names_of(InflationSettings)) - {"enabled"},
}


def costmap_settings(reader: Reader, values, name: str, parameters) -> CostmapSettings:
    values = with_plugins(values)
    for inherited in ("footprint", "robot_radius", "footprint_padding"):
        if inherited in parameters:
            values.setdefault(inherited, parameters[inherited])
    if "footprint" in values:
        values["footprint"] = _corners(values["footprint"], f"{reader.where}{name}/footprint")
    settings = reader.read(CostmapSettings, values, name + "/", _COSTMAP_IGNORED)
    static = StaticSettings(enabled=False)
    obstacles = ObstacleSettings(enabled=False)
    inflation = InflationSettings(enabled=False)
    for layer, kind in layers_of(reader, values, name).items():
        tree, where = dict(below(values, layer)), f"{name}/{layer}/"
        if kind == "StaticLayer":
            static = reader.read(StaticSettings, tree, where, _STATIC_IGNORED)
        elif kind == "InflationLayer":
            inflation = reader.read(InflationSettings, tree, where)
        else:
            tree.setdefault("track_unknown_space", settings.track_unknown_space)
            earlier = obstacles.sources
            obstacles = _obstacle_settings(reader, tree, where, [values, parameters])
            obstacles = replace(obstacles, sources=(*earlier, *obstacles.sources))
    return replace(settings, static=static, obstacles=obstacles, inflation=inflation)


def with_plugins(values: Mapping[str, Any]) -> Dict[str, Any]:
    """A costmap's parameters with a list of plugins, made as costmap_2d does if they are older than that."""
    if "plugins" in values:
        return dict(values)
    obstacles = "VoxelLayer" if values.get("map_type") == "voxel" else "ObstacleLayer"
    kinds = {"static_layer": "StaticLayer"} if values.get("static_map") else {}
    kinds.update({"obstacle_layer": obstacles, "inflation_layer": "InflationLayer"})
    moved: Dict[str, Any] = {"plugins": [], **{layer: {} for layer in kinds}}
    for layer, kind in kinds.items():
        moved["plugins"].append({"name": layer, "type": f"costmap_2d::{kind}"})
    for key, value in values.items():
        for layer, kind in kinds.items():
            if key in _LAYER_KEYS[kind] or (isinstance(value, dict) and layer == "obstacle_layer"):
                moved[layer][key] = value
        if not (isinstance(value, dict) or any(key in keys for keys in _LAYER_KEYS.values())):
            moved[key] = value
    if "track_unknown_space" in values:
        moved["track_unknown_space"] = values["track_unknown_space"]
    return moved


def layers_of(reader: Reader, values: Mapping[str, Any], name: str) -> Dict[str, str]:
    """The kind of each layer that there is here, by its name, in order."""
    layers = {}
    for plugin in values["plugins"]:
        if not isinstance(plugin, dict) or not {"name", "type"} <= set(plugin):
            raise SettingsError(
                f"{reader.where}{name}/plugins must be a list of {{name, type}}, got {plugin!r}"
            )
        kind = str(plugin["type"]).rpartition("::")[2]
        if kind in _LAYER_KEYS:
            layers[plugin["name"]] = kind
        else:
            reader.warnings.append(f"no layer of type {plugin['type']} here, {plugin['name']} is left out")
    return layers


def _obstacle_settings(reader: Reader, tree, where: str, outer: List[Mapping[str, Any]]) -> ObstacleSettings:
    """A layer with its sources; their ranges are searched for in the namespaces around them too."""
    layer = reader.read(ObstacleSettings, tree, where, _OBSTACLE_IGNORED)
    sources = []
    for name in str(tree.get("observation_sources", "")).split():
        own = {"topic": name, **below(tree, name)}
        for key in ("obstacle_range", "raytrace_range"):
            for around in (tree, *outer):
                if key in around:
                    own.setdefault(key, around[key])
        sources.append(reader.read(SourceSettings, own, f"{where}{name}/"))
    return replace(layer, sources=tuple(sources))


def _corners(value: Any, name: str) -> Tuple[Tuple[float, float], ...]:
    try:
        points = yaml.safe_load(value) if isinstance(value, str) else value
        return tuple((float(x), float(y)) for x, y in points)
    except (yaml.YAMLError, TypeError, ValueError):
        raise SettingsError(f"{name} must be a list of points [x, y], got {value!r}") from None
