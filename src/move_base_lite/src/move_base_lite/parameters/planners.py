"""Parameters of global and local planners."""

from typing import Any, Dict, TypeVar

from move_base_lite.control import LOCAL_PLANNERS, ControllerSettings
from move_base_lite.parameters.reader import ParameterReader, Tree, subtree
from move_base_lite.planning import GLOBAL_PLANNERS, PlannerSettings
from move_base_lite.plugin import Plugin, Registry

T = TypeVar("T")
GLOBAL_KEY, LOCAL_KEY = "base_global_planner", "base_local_planner"
# By the parameter that chooses among them.
PLANNERS: Dict[str, Registry[Any]] = {GLOBAL_KEY: GLOBAL_PLANNERS, LOCAL_KEY: LOCAL_PLANNERS}


def controller_settings(reader: ParameterReader, parameters: Tree) -> ControllerSettings:
    """Those of the local planner that is asked for."""
    planner = _asked_for(reader, parameters, LOCAL_KEY, LOCAL_PLANNERS)
    values = dict(subtree(parameters, planner.short_name))
    if "latch_xy_goal_tolerance" in parameters:
        values.setdefault("latch_xy_goal_tolerance", parameters["latch_xy_goal_tolerance"])
    return reader.read_plugin(planner, values, planner.short_name + "/")


def planner_settings(reader: ParameterReader, parameters: Tree) -> PlannerSettings:
    """Those of the global planner that is asked for."""
    planner = _asked_for(reader, parameters, GLOBAL_KEY, GLOBAL_PLANNERS)
    return reader.read_plugin(planner, subtree(parameters, planner.short_name), planner.short_name + "/")


def _asked_for(reader: ParameterReader, parameters: Tree, key: str, registry: Registry[T]) -> Plugin[T]:
    """The planner asked for; the first one known takes the place of others."""
    first = registry.members[0]
    name = str(parameters.get(key, first.name))
    planner = reader.find(registry, name, key)
    if planner is None:
        kind = key.split("_")[1]
        reader.warnings.append(f"no {kind} planner {name} here, {first.name} takes its place")
    return planner or first
