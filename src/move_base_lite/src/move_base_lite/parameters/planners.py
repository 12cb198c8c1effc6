"""Parameters of global and local planners."""

from typing import Any, Dict, TypeVar

from move_base_lite.control import LOCAL_PLANNERS, ControllerSettings
from move_base_lite.parameters.reader import ParameterReader, Tree, subtree
from move_base_lite.planning import GLOBAL_PLANNERS, PlannerSettings
from planar.extensions import Plugin, Registry, registries_of

T = TypeVar("T")
# Registries by the parameter that selects a plugin.
REGISTRIES: Dict[str, Registry[Any]] = registries_of("move_base_lite")


def controller_settings(reader: ParameterReader, parameters: Tree) -> ControllerSettings:
    """Read the settings of the selected local planner."""
    planner = _selected(reader, parameters, LOCAL_PLANNERS)
    values = dict(subtree(parameters, planner.short_name))
    if "latch_xy_goal_tolerance" in parameters:
        values.setdefault("latch_xy_goal_tolerance", parameters["latch_xy_goal_tolerance"])
    return reader.read_plugin(planner, values, planner.short_name + "/")


def planner_settings(reader: ParameterReader, parameters: Tree) -> PlannerSettings:
    """Read the settings of the selected global planner."""
    return selected_settings(reader, parameters, GLOBAL_PLANNERS)


def other_settings(reader: ParameterReader, parameters: Tree) -> Dict[str, Any]:
    """Read the settings of all selected plugins but the planners, by the parameter that selects them."""
    return {
        key: selected_settings(reader, parameters, registry)
        for key, registry in REGISTRIES.items()
        if registry not in (GLOBAL_PLANNERS, LOCAL_PLANNERS)
    }


def selected_settings(reader: ParameterReader, parameters: Tree, registry: Registry[Any]) -> Any:
    """Read the settings of the plugin that is selected from a registry, from the namespace of its name."""
    plugin = _selected(reader, parameters, registry)
    return reader.read_plugin(plugin, subtree(parameters, plugin.short_name), plugin.short_name + "/")


def _selected(reader: ParameterReader, parameters: Tree, registry: Registry[T]) -> Plugin[T]:
    """Find the selected plugin; the default replaces an unknown one, with a warning."""
    default, key = registry.members[0], registry.point.parameter
    name = str(parameters.get(key, default.name))
    plugin = reader.find(registry, name, key)
    if plugin is None:
        reader.warnings.append(
            f"{reader.where}{key}: unknown {registry.point.kind} {name}, {default.name} is used instead"
        )
    return plugin or default
