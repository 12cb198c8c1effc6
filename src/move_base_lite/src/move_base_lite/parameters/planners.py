"""Parameters of global and local planners."""

from typing import Any, Dict, TypeVar

from move_base_lite.control import LOCAL_PLANNERS, ControllerSettings
from move_base_lite.parameters.reader import ParameterReader, Tree, subtree
from move_base_lite.planning import GLOBAL_PLANNERS, PlannerSettings
from planar.extensions import Plugin, Registry

T = TypeVar("T")
GLOBAL_KEY, LOCAL_KEY = "base_global_planner", "base_local_planner"
# Registries by the parameter that selects a plugin.
PLANNERS: Dict[str, Registry[Any]] = {GLOBAL_KEY: GLOBAL_PLANNERS, LOCAL_KEY: LOCAL_PLANNERS}


def controller_settings(reader: ParameterReader, parameters: Tree) -> ControllerSettings:
    """Read the settings of the selected local planner."""
    planner = _selected(reader, parameters, LOCAL_KEY, LOCAL_PLANNERS)
    values = dict(subtree(parameters, planner.short_name))
    if "latch_xy_goal_tolerance" in parameters:
        values.setdefault("latch_xy_goal_tolerance", parameters["latch_xy_goal_tolerance"])
    return reader.read_plugin(planner, values, planner.short_name + "/")


def planner_settings(reader: ParameterReader, parameters: Tree) -> PlannerSettings:
    """Read the settings of the selected global planner."""
    planner = _selected(reader, parameters, GLOBAL_KEY, GLOBAL_PLANNERS)
    return reader.read_plugin(planner, subtree(parameters, planner.short_name), planner.short_name + "/")


def _selected(reader: ParameterReader, parameters: Tree, key: str, registry: Registry[T]) -> Plugin[T]:
    """Find the selected planner; the default replaces an unknown one, with a warning."""
    default = registry.members[0]
    name = str(parameters.get(key, default.name))
    planner = reader.find(registry, name, key)
    if planner is None:
        kind = key.split("_")[1]
        reader.warnings.append(
            f"{reader.where}{key}: unknown {kind} planner {name}, {default.name} is used instead"
        )
    return planner or default
