"""Parameters of costmaps and their layers."""

import re
from dataclasses import replace
from typing import Any, Dict, List, Mapping, Set, Tuple

import yaml

from move_base_lite.costmap import LAYERS, CostmapSettings, Layer
from move_base_lite.costmap.layers.inflation import INFLATION
from move_base_lite.costmap.layers.obstacles import OBSTACLES, ObstacleSettings, SourceSettings
from move_base_lite.costmap.layers.static import STATIC
from move_base_lite.costmap.layers.voxels import VOXEL
from move_base_lite.costmap.settings import NamedLayer
from move_base_lite.parameters.reader import ParameterReader, Tree, subtree
from planar import SettingsError
from planar.config.bounded_yaml import load_yaml
from planar.extensions import Plugin
from planar.extensions.registry import short_name

# Parameters that costmaps inherit from move_base's namespace.
INHERITED = ("footprint", "robot_radius", "footprint_padding")
# Parameters that costmap_2d also searches in the namespaces above that of move_base.
SEARCHED = ("footprint", "robot_radius", "obstacle_range", "raytrace_range")
# Parameters that are read by other means.
_ELSEWHERE = {"plugins", "footprint_topic"}
_VOXEL_KEYS = (
    "origin_z", "z_resolution", "z_voxels", "mark_threshold", "unknown_threshold", "publish_voxel_map",
)  # fmt: skip
# Parameters of a layer that may stand in the costmap's namespace; they then apply to all layers of the kind,
# also over the layer's own (costmap_2d_ros: copyParentParameters).
_OF_COSTMAP: Dict[str, Tuple[str, ...]] = {
    STATIC.name: ("map_topic", "unknown_cost_value", "lethal_cost_threshold", "track_unknown_space"),
    OBSTACLES.name: ("max_obstacle_height", "raytrace_range", "obstacle_range", "track_unknown_space"),
    VOXEL.name: _VOXEL_KEYS,
    INFLATION.name: ("cost_scaling_factor", "inflation_radius"),
}
# Those among them that the costmap or the sources of other layers read, too.
_SHARED = {"track_unknown_space", "raytrace_range", "obstacle_range"}
# Official parameters that nothing reads, with the reason.
_WITHOUT_EFFECT = {
    "static_map": "plugins lists the layers",
    "map_type": "plugins lists the layers",
    "inscribed_radius": "it follows from the footprint",
    "circumscribed_radius": "it follows from the footprint",
    **{
        key: f"plugins lists no {kind}"
        for kind, keys in _OF_COSTMAP.items()
        for key in keys
        if key not in _SHARED
    },
}


def costmap_settings(reader: ParameterReader, values: Tree, name: str, parameters: Tree) -> CostmapSettings:
    """Read the settings of one costmap and its layers.

    Args:
        reader: Reads the values and collects warnings.
        values: Parameters of the costmap.
        name: Namespace of the costmap.
        parameters: Parameters of move_base, from which frames and the like are inherited.

    Raises:
        SettingsError: A value is invalid.
    """
    values = with_layer_tables(values, f"{reader.where}{name}/")
    for inherited in INHERITED:
        if inherited in parameters:
            values.setdefault(inherited, parameters[inherited])
    if "footprint" in values:
        values["footprint"] = parse_footprint(values["footprint"], f"{reader.where}{name}/footprint")
    plugins = layer_plugins(reader, values, name)
    for key in [key for key in _WITHOUT_EFFECT if key in values]:
        reader.without_effect.add(f"{reader.where}{name}/{key}", _WITHOUT_EFFECT[key])
    elsewhere = {*_ELSEWHERE, *_WITHOUT_EFFECT, *_SHARED} - {"track_unknown_space"}
    settings = reader.read(CostmapSettings, values, name + "/", elsewhere)
    reader.report_unused(values, name + "/", dict(plugins), "plugins lists no layer of this name")
    layers = []
    for layer, kind in plugins:
        tree, where = dict(subtree(values, layer)), f"{name}/{layer}/"
        if kind in (OBSTACLES, VOXEL):
            tree.setdefault("track_unknown_space", settings.track_unknown_space)
            layer_settings = _obstacle_settings(reader, kind, tree, where, [values, parameters])
        else:
            layer_settings = reader.read_plugin(kind, tree, where)
        layers.append(NamedLayer(layer, layer_settings))
    return replace(settings, layers=tuple(layers))


def with_layer_tables(values: Mapping[str, Any], where: str) -> Dict[str, Any]:
    """Convert a costmap's parameters to a list of plugins and one table for each layer, as costmap_2d does.

    Args:
        values: Parameters of the costmap.
        where: Prefix of parameter names in messages.

    Raises:
        SettingsError: The parameters of a layer are not a table.
    """
    tables = dict(values) if "plugins" in values else _with_plugin_list(values)
    copied: Set[str] = set()
    for layer, kind in _listed(tables["plugins"]):
        own = tables.get(layer, {})
        if not isinstance(own, dict):
            raise SettingsError(f"{where}{layer} must be a table of parameters, got {own!r}")
        moved = {key: values[key] for key in _OF_COSTMAP.get(kind, ()) if key in values}
        tables[layer] = {**own, **moved}
        copied.update(moved)
    return {key: each for key, each in tables.items() if key not in copied - _SHARED}


def _with_plugin_list(values: Mapping[str, Any]) -> Dict[str, Any]:
    """Convert parameters from before ``plugins`` (costmap_2d_ros: loadOldParameters)."""
    obstacles = VOXEL if values.get("map_type") == "voxel" else OBSTACLES
    kinds = {"obstacle_layer": obstacles.name, "inflation_layer": INFLATION.name}
    if values.get("static_map"):
        kinds = {"static_layer": STATIC.name, **kinds}
    sources = str(values.get("observation_sources", "")).split()
    moved = {"max_obstacle_height", "observation_sources", *sources, *_OF_COSTMAP[OBSTACLES.name]}
    own, dropped = values.get("obstacle_layer", {}), {"plugins", "static_map", "map_type", *moved} - _SHARED
    tables = {key: each for key, each in values.items() if key not in dropped}
    tables["plugins"] = [{"name": layer, "type": kind} for layer, kind in kinds.items()]
    if isinstance(own, dict):
        tables["obstacle_layer"] = {**own, **{key: values[key] for key in moved if key in values}}
    return tables


def _listed(plugins: Any) -> List[Tuple[str, str]]:
    """Names and official types of the layers in a list of plugins, which may be malformed."""
    official = {short_name(kind): kind for kind in _OF_COSTMAP}
    return [
        (str(each.get("name")), official.get(short_name(str(each.get("type"))), ""))
        for each in (plugins if isinstance(plugins, list) else [])
        if isinstance(each, dict)
    ]


def layer_plugins(reader: ParameterReader, values: Tree, name: str) -> List[Tuple[str, Plugin[Layer]]]:
    """Find the plugins of a costmap's layers; unknown types are skipped with a warning.

    Args:
        reader: Finds the plugins and collects warnings.
        values: Parameters of the costmap, with ``plugins``.
        name: Namespace of the costmap.

    Returns:
        Names and plugins of the layers, in order; each name once.

    Raises:
        SettingsError: ``plugins`` is not a list of names and types.
    """
    layers: Dict[str, Plugin[Layer]] = {}
    plugins = values["plugins"]
    for plugin in plugins if isinstance(plugins, list) else [plugins]:
        if not isinstance(plugin, dict) or not all(
            isinstance(plugin.get(key), str) for key in ("name", "type")
        ):
            raise SettingsError(
                f"{reader.where}{name}/plugins must be a list of {{name, type}}, got {plugin!r}"
            )
        kind = reader.find(LAYERS, str(plugin["type"]), f"{name}/plugins", is_package_needed=False)
        if kind is None:
            reader.warnings.append(
                f"{reader.where}{name}/plugins: {plugin['name']} has the unknown type {plugin['type']}"
            )
        elif plugin["name"] in layers:
            entry = f"{reader.where}{name}/plugins: the second entry {plugin['name']}"
            reader.without_effect.add(entry, "names of layers must differ")
        else:
            layers[plugin["name"]] = kind
    return [*layers.items()]


def _obstacle_settings(
    reader: ParameterReader, kind: Plugin[Layer], tree: Tree, where: str, outer: List[Tree]
) -> ObstacleSettings:
    """Read an obstacle layer and its sources; ranges are also searched in the enclosing namespaces."""
    layer = reader.read_plugin(kind, tree, where)
    sources, names = [], str(tree.get("observation_sources", "")).split()
    reader.report_unused(tree, where, names, "observation_sources does not list it")
    for name in names:
        own = {"topic": name, **subtree(tree, name)}
        for key in ("obstacle_range", "raytrace_range"):
            for namespace in (tree, *outer):
                if key in namespace:
                    own.setdefault(key, namespace[key])
        sources.append(reader.read(SourceSettings, own, f"{where}{name}/"))
    return replace(layer, sources=tuple(sources))


def parse_footprint(value: Any, name: str) -> Tuple[Tuple[float, float], ...]:
    """Parse a footprint: a list of points [x, y], or such a list as text.

    Args:
        value: Value of the parameter.
        name: Full name of the parameter, for messages.

    Returns:
        Corners (x, y) in the base frame [m].

    Raises:
        SettingsError: The value is not a list of points.
    """
    try:
        points = load_yaml(_with_commas(value)) if isinstance(value, str) else value
        return tuple((float(x), float(y)) for x, y in points or ())
    except (yaml.YAMLError, TypeError, ValueError, OverflowError):
        raise SettingsError(f"{name} must be a list of points [x, y], got {value!r}") from None


def _with_commas(text: str) -> str:
    """Separate points and numbers by commas, which costmap_2d does not need: ``[[0 1] [2 3] [4 5]]``."""
    return re.sub(r"(?<=[\d.])\s+(?=[\d.+-])|(?<=\])\s*(?=\[)", ", ", text)
