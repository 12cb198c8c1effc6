"""Parameters of costmaps and their layers."""

from dataclasses import replace
from typing import Any, Dict, List, Mapping, Set, Tuple

import yaml

from move_base_lite.costmap import LAYERS, CostmapSettings, Layer, LayerSettings
from move_base_lite.costmap.layers.inflation import INFLATION, InflationSettings
from move_base_lite.costmap.layers.obstacles import OBSTACLES, VOXEL, ObstacleSettings, SourceSettings
from move_base_lite.costmap.layers.static import STATIC, StaticSettings
from move_base_lite.parameters.reader import ParameterReader, Tree, parameter_names, subtree
from planar import SettingsError
from planar.config.bounded_yaml import load_yaml
from planar.extensions import Plugin

# Parameters that costmaps inherit from move_base's namespace.
INHERITED = ("footprint", "robot_radius", "footprint_padding")
# Parameters that are accepted without effect, or read elsewhere.
_COSTMAP_IGNORED = {
    "plugins", "static_map", "map_type", "inscribed_radius", "circumscribed_radius",
    "footprint_topic", "published_footprint_topic",
}  # fmt: skip


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
    values = with_plugin_list(values, f"{reader.where}{name}/")
    for inherited in INHERITED:
        if inherited in parameters:
            values.setdefault(inherited, parameters[inherited])
    if "footprint" in values:
        values["footprint"] = parse_footprint(values["footprint"], f"{reader.where}{name}/footprint")
    settings = reader.read(CostmapSettings, values, name + "/", _COSTMAP_IGNORED)
    static = StaticSettings(enabled=False)
    obstacles = ObstacleSettings(enabled=False)
    inflation = InflationSettings(enabled=False)
    plugin_layers: List[LayerSettings] = []
    for layer, kind in layer_plugins(reader, values, name).items():
        tree, where = subtree(values, layer), f"{name}/{layer}/"
        if kind in (OBSTACLES, VOXEL):
            tree = {"track_unknown_space": settings.track_unknown_space, **tree}
            earlier = obstacles.sources
            obstacles = _obstacle_settings(reader, kind, tree, where, [values, parameters])
            obstacles = replace(obstacles, sources=(*earlier, *obstacles.sources))
        elif kind is STATIC:
            static = reader.read_plugin(kind, tree, where)
        elif kind is INFLATION:
            inflation = reader.read_plugin(kind, tree, where)
        else:
            plugin_layers.append(reader.read_plugin(kind, tree, where))
    return replace(
        settings, static=static, obstacles=obstacles, plugin_layers=tuple(plugin_layers), inflation=inflation
    )


def with_plugin_list(values: Mapping[str, Any], where: str) -> Dict[str, Any]:
    """Convert a costmap's parameters from before ``plugins`` to a list of plugins, as costmap_2d does.

    Args:
        values: Parameters of the costmap.
        where: Prefix of parameter names in messages.

    Raises:
        SettingsError: The parameters of a layer are not a table.
    """
    if "plugins" in values:
        return dict(values)
    kinds = {"static_layer": STATIC} if values.get("static_map") else {}
    kinds["obstacle_layer"] = VOXEL if values.get("map_type") == "voxel" else OBSTACLES
    kinds["inflation_layer"] = INFLATION
    moved: Dict[str, Any] = {"plugins": [], **{layer: {} for layer in kinds}}
    for layer, kind in kinds.items():
        if not isinstance(values.get(layer, {}), dict):
            raise SettingsError(f"{where}{layer} must be a table of parameters, got {values[layer]!r}")
        moved["plugins"].append({"name": layer, "type": kind.name})
    all_keys = set().union(*map(_keys_of, (STATIC, OBSTACLES, INFLATION)))
    for key, value in values.items():
        for layer, kind in kinds.items():
            if key in _keys_of(kind) or (isinstance(value, dict) and layer == "obstacle_layer"):
                moved[layer][key] = value
        if not (isinstance(value, dict) or key in all_keys):
            moved[key] = value
    if "track_unknown_space" in values:
        moved["track_unknown_space"] = values["track_unknown_space"]
    return moved


def _keys_of(kind: Plugin[Layer]) -> Set[str]:
    """Parameters of a layer that stand in the costmap's namespace if there is no list of plugins."""
    return {*parameter_names(kind.settings), *kind.meaningless} - {"enabled"}


def layer_plugins(reader: ParameterReader, values: Tree, name: str) -> Dict[str, Plugin[Layer]]:
    """Find the plugins of a costmap's layers; unknown types are skipped with a warning.

    Args:
        reader: Finds the plugins and collects warnings.
        values: Parameters of the costmap, with ``plugins``.
        name: Namespace of the costmap.

    Returns:
        Plugin by the name of the layer, in order.

    Raises:
        SettingsError: ``plugins`` is not a list of names and types.
    """
    layers = {}
    plugins = values["plugins"]
    for plugin in plugins if isinstance(plugins, list) else [plugins]:
        if not isinstance(plugin, dict) or not all(
            isinstance(plugin.get(key), str) for key in ("name", "type")
        ):
            raise SettingsError(
                f"{reader.where}{name}/plugins must be a list of {{name, type}}, got {plugin!r}"
            )
        kind = reader.find(LAYERS, str(plugin["type"]), f"{name}/plugins", is_package_needed=False)
        if kind is not None:
            layers[plugin["name"]] = kind
        else:
            reader.warnings.append(
                f"{reader.where}{name}/plugins: {plugin['name']} has the unknown type {plugin['type']}"
            )
    return layers


def _obstacle_settings(
    reader: ParameterReader, kind: Plugin[Layer], tree: Tree, where: str, outer: List[Tree]
) -> ObstacleSettings:
    """Read an obstacle layer and its sources; ranges are also searched in the enclosing namespaces."""
    layer = reader.read_plugin(kind, tree, where)
    sources = []
    for name in str(tree.get("observation_sources", "")).split():
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
        points = load_yaml(value) if isinstance(value, str) else value
        return tuple((float(x), float(y)) for x, y in points)
    except (yaml.YAMLError, TypeError, ValueError, OverflowError):
        raise SettingsError(f"{name} must be a list of points [x, y], got {value!r}") from None
