"""Parameters that dynamic_reconfigure can change: those in the .cfg files of the official packages."""

import math
from dataclasses import replace
from typing import Any, Dict, List, Optional, Sequence, Tuple

from move_base_lite.config import MoveBaseSettings
from move_base_lite.costmap import CostmapSettings
from move_base_lite.parameters.costmaps import INHERITED, layer_plugins, with_layer_tables
from move_base_lite.parameters.planners import REGISTRIES
from move_base_lite.parameters.reader import ParameterReader, Tree, subtree
from planar.config.parameters import DynamicParameter, dynamic_parameters_of
from planar.extensions import Plugin

COSTMAPS = ("global_costmap", "local_costmap")
# Parameters that a namespace inherits from move_base's own.
_INHERITED = (*INHERITED, "latch_xy_goal_tolerance")


def reconfigure_servers(parameters: Tree) -> Dict[str, List[Tuple[DynamicParameter, Any]]]:
    """Collect the parameters of each dynamic_reconfigure server.

    Args:
        parameters: Parameters of move_base, a nested dictionary.

    Returns:
        Parameters with their present values, by the namespace of the server.
    """
    planner_choices = [
        DynamicParameter(key, registry.names[0], registry.point.kind) for key, registry in REGISTRIES.items()
    ]
    found = {"": _with_values(parameters, "", [*planner_choices, *dynamic_parameters_of(MoveBaseSettings)])}
    for costmap in COSTMAPS:
        found[costmap] = _with_values(parameters, costmap, dynamic_parameters_of(CostmapSettings))
        values = with_layer_tables(subtree(parameters, costmap), f"{costmap}/")
        for layer, kind in layer_plugins(ParameterReader(""), values, costmap):
            found[f"{costmap}/{layer}"] = _with_values(parameters, f"{costmap}/{layer}", kind.tunables, kind)
    for key, registry in REGISTRIES.items():
        planner = registry.find(str(parameters.get(key, registry.names[0])), is_package_needed=False)
        if planner is not None and planner.tunables:
            name = planner.short_name
            found[name] = _with_values(parameters, name, planner.tunables, planner)
    return found


def with_changes(parameters: Tree, namespace: str, values: Tree) -> Dict[str, Any]:
    """Return the parameters with other values in a namespace.

    Args:
        parameters: Parameters of move_base, a nested dictionary.
        namespace: Namespace below move_base.
        values: New values by name.
    """
    name, _, rest = namespace.partition("/")
    if not name:
        return {**parameters, **values}
    tree = subtree(parameters, name)
    if name in COSTMAPS:
        tree = with_layer_tables(tree, f"{name}/")
    return {**parameters, name: with_changes(tree, rest, values)}


def _with_values(
    parameters: Tree, namespace: str, tunables: Sequence[DynamicParameter], kind: Optional[Plugin] = None
) -> List[Tuple[DynamicParameter, Any]]:
    """Pair tunables with their present values, which may be inherited or have an old name."""
    tree = parameters
    for name in filter(None, namespace.split("/")):
        tree = subtree(tree, name)
        tree = with_layer_tables(tree, f"{name}/") if name in COSTMAPS else tree
    offered = []
    for tunable in map(_message_form, tunables):
        names = (tunable.name, *(kind.old_names(tunable.name) if kind else ()))
        value = next((tree[name] for name in names if name in tree), None)
        if value is None and tunable.name in _INHERITED:
            value = parameters.get(tunable.name)
        offered.append((tunable, tunable.default if value is None else _converted(tunable.default, value)))
    return offered


def _message_form(tunable: DynamicParameter) -> DynamicParameter:
    """Give a footprint the text form it has in messages."""
    return replace(tunable, default="[]") if tunable.default == () else tunable


def _converted(default: Any, value: Any) -> Any:
    """Convert a value to the type of the default, which it has in messages."""
    if isinstance(default, str):
        return str(value)
    return math.inf if value == "inf" else type(default)(value)
