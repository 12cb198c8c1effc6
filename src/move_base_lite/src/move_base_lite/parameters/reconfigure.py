"""What dynamic_reconfigure may change: the parameters that the official packages' .cfg files list."""

import math
from dataclasses import replace
from typing import Any, Dict, List, Optional, Sequence, Tuple

from move_base_lite.config import MoveBaseSettings
from move_base_lite.costmap import CostmapSettings
from move_base_lite.parameters.costmaps import INHERITED, layer_plugins, with_plugin_list
from move_base_lite.parameters.planners import PLANNERS
from move_base_lite.parameters.reader import ParameterReader, Tree, subtree
from move_base_lite.plugin import Plugin
from planar.config.parameters import DynamicParameter, dynamic_parameters_of

COSTMAPS = ("global_costmap", "local_costmap")
# What a namespace has from move_base's own, unless it says otherwise.
_FROM_ABOVE = (*INHERITED, "latch_xy_goal_tolerance")


def reconfigure_servers(parameters: Tree) -> Dict[str, List[Tuple[DynamicParameter, Any]]]:
    """By namespace below move_base: what may be changed there, with the values in force."""
    chosen = [
        DynamicParameter(key, registry.names[0], key.replace("_", " ")[5:])
        for key, registry in PLANNERS.items()
    ]
    found = {"": _offered(parameters, "", [*chosen, *dynamic_parameters_of(MoveBaseSettings)])}
    for costmap in COSTMAPS:
        found[costmap] = _offered(parameters, costmap, dynamic_parameters_of(CostmapSettings))
        values = with_plugin_list(subtree(parameters, costmap), f"{costmap}/")
        for layer, kind in layer_plugins(ParameterReader(""), values, costmap).items():
            found[f"{costmap}/{layer}"] = _offered(parameters, f"{costmap}/{layer}", kind.tunables, kind)
    for key, registry in PLANNERS.items():
        planner = registry.find(str(parameters.get(key, registry.names[0])), is_package_needed=False)
        if planner is not None and planner.tunables:
            name = planner.short_name
            found[name] = _offered(parameters, name, planner.tunables, planner)
    return found


def with_changes(parameters: Tree, namespace: str, values: Tree) -> Dict[str, Any]:
    """The parameters with other values in a namespace below move_base."""
    name, _, rest = namespace.partition("/")
    if not name:
        return {**parameters, **values}
    tree = subtree(parameters, name)
    if name in COSTMAPS:
        tree = with_plugin_list(tree, f"{name}/")
    return {**parameters, name: with_changes(tree, rest, values)}


def _offered(
    parameters: Tree, namespace: str, tunables: Sequence[DynamicParameter], kind: Optional[Plugin] = None
) -> List[Tuple[DynamicParameter, Any]]:
    """The tunables with their values in force, also if these are inherited or have an old name."""
    tree = parameters
    for name in filter(None, namespace.split("/")):
        tree = subtree(tree, name)
        tree = with_plugin_list(tree, f"{name}/") if name in COSTMAPS else tree
    offered = []
    for tunable in map(_in_a_message, tunables):
        names = (tunable.name, *(kind.old_names(tunable.name) if kind else ()))
        value = next((tree[name] for name in names if name in tree), None)
        if value is None and tunable.name in _FROM_ABOVE:
            value = parameters.get(tunable.name)
        offered.append((tunable, tunable.default if value is None else _like(tunable.default, value)))
    return offered


def _in_a_message(tunable: DynamicParameter) -> DynamicParameter:
    """A footprint is a text there."""
    return replace(tunable, default="[]") if tunable.default == () else tunable


def _like(default: Any, value: Any) -> Any:
    """The value, of the type it has in messages."""
    if isinstance(default, str):
        return str(value)
    return math.inf if value == "inf" else type(default)(value)
