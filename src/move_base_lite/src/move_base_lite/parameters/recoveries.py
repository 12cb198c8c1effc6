"""Parameters of recovery behaviours."""

from typing import Any, Dict, List, Tuple

from move_base_lite.config import MoveBaseSettings
from move_base_lite.costmap import CostmapSettings, footprint_from
from move_base_lite.parameters.costmaps import layer_plugins, with_layer_tables
from move_base_lite.parameters.reader import ParameterReader, Tree, parameter_names, renamed, subtree
from move_base_lite.recovery import RECOVERIES, NamedRecovery, RecoveryBehavior
from move_base_lite.recovery.clear_costmap import CLEAR_COSTMAP
from move_base_lite.recovery.rotate import ROTATE
from planar import SettingsError
from planar.extensions import Plugin

# Types of move_base's recovery behaviours by name, in order.
DEFAULT_RECOVERIES = {
    "conservative_reset": CLEAR_COSTMAP.name,
    "rotate_recovery": ROTATE.name,
    "aggressive_reset": CLEAR_COSTMAP.name,
    "rotate_recovery_again": ROTATE.name,
}


def recovery_settings(
    reader: ParameterReader, parameters: Tree, move_base: MoveBaseSettings, local: CostmapSettings
) -> Tuple[NamedRecovery, ...]:
    """Read the list of recovery behaviours with their settings.

    Args:
        reader: Reads the values and collects warnings.
        parameters: Parameters of move_base.
        move_base: Settings of move_base, for the default behaviours.
        local: Settings of the local costmap, whose footprint determines the size of ``aggressive_reset``.

    Raises:
        SettingsError: A value is invalid.
    """
    footprint = footprint_from(local.footprint, local.robot_radius, local.footprint_padding)
    distances = {
        "conservative_reset": move_base.conservative_reset_dist,
        "aggressive_reset": 4.0 * footprint.circumscribed_radius,
    }
    recoveries = []
    for item in _listed(reader, parameters, move_base.clearing_rotation_allowed):
        name, kind = item["name"], str(item["type"])
        behavior = reader.find(RECOVERIES, kind, "recovery_behaviors", is_package_needed=False)
        if behavior is None:
            raise SettingsError(f"recovery_behaviors: {name} has an unknown type {kind!r}")
        values = dict(subtree(parameters, name))
        if behavior is CLEAR_COSTMAP and name in distances:
            values.setdefault("reset_distance", distances[name])
        recoveries.append(NamedRecovery(name, _settings_of(reader, parameters, name, behavior, values)))
    return tuple(recoveries)


def _listed(reader: ParameterReader, parameters: Tree, rotation_allowed: bool) -> List[Dict[str, Any]]:
    listed = parameters.get("recovery_behaviors")
    if listed is None:
        return _default_recoveries(rotation_allowed)
    items = listed if isinstance(listed, list) else [listed]
    names = [item["name"] for item in items if isinstance(item, dict) and {"name", "type"} <= set(item)]
    is_usable = len(names) == len(items) and all(isinstance(name, str) for name in names)
    if not is_usable or len(set(names)) != len(names):
        reader.warnings.append(
            f"{reader.where}recovery_behaviors must be a list of {{name, type}} with different names, "
            "the default ones are used instead"
        )
        return _default_recoveries(rotation_allowed)
    return items


def _settings_of(
    reader: ParameterReader, parameters: Tree, name: str, behavior: Plugin[RecoveryBehavior], values: Tree
) -> Any:
    if behavior is ROTATE:
        return _rotate_settings(reader, parameters, name, values)
    if behavior is CLEAR_COSTMAP and "layer_names" in values:
        values = {**values, "layer_names": _known_layers(reader, parameters, name, values["layer_names"])}
    return reader.read_plugin(behavior, values, f"{name}/")


def _rotate_settings(reader: ParameterReader, parameters: Tree, name: str, values: Tree) -> Any:
    """Read the settings of rotate_recovery, whose namespace is TrajectoryPlannerROS."""
    reader.read_ignored(ROTATE, values, f"{name}/")
    shared = renamed(subtree(parameters, "TrajectoryPlannerROS"), ROTATE.synonyms)
    values = {key: value for key, value in shared.items() if key in parameter_names(ROTATE.settings)}
    return reader.read_plugin(ROTATE, values, "TrajectoryPlannerROS/")


def _known_layers(reader: ParameterReader, parameters: Tree, name: str, named: Any) -> Tuple[str, ...]:
    """Return the layers to clear, with a warning for unknown ones; without a known one all are cleared."""
    existing = {
        layer
        for costmap in ("global_costmap", "local_costmap")
        for layer, _ in layer_plugins(
            ParameterReader(reader.where),
            with_layer_tables(subtree(parameters, costmap), f"{reader.where}{costmap}/"),
            costmap,
        )
    }
    listed = named if isinstance(named, list) else [named]
    known = tuple(layer for layer in listed if isinstance(layer, str) and layer in existing)
    consequence = "" if known else "; the obstacles of all layers are cleared"
    for layer in listed:
        if layer not in known:
            reader.warnings.append(
                f"{reader.where}{name}/layer_names: no costmap has a layer {layer} "
                f"(there are {', '.join(sorted(existing))}){consequence}"
            )
    return known


def _default_recoveries(rotation_allowed: bool) -> List[Dict[str, Any]]:
    return [
        {"name": name, "type": kind}
        for name, kind in DEFAULT_RECOVERIES.items()
        if rotation_allowed or kind != ROTATE.name
    ]
