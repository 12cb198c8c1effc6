"""The checks of each seam."""

from dataclasses import dataclass
from typing import Any, Callable, Tuple

from move_base_lite.check import global_planners, layers, local_planners, recoveries
from move_base_lite.control import LOCAL_PLANNERS
from move_base_lite.costmap import LAYERS
from move_base_lite.planning import GLOBAL_PLANNERS
from move_base_lite.plugin import Plugin, Registry
from move_base_lite.recovery import RECOVERIES

Check = Callable[[Plugin[Any]], None]


@dataclass(frozen=True)
class Kit:
    """A seam and what its members have to do."""

    registry: Registry[Any]
    checks: Tuple[Check, ...]


KITS = {
    "local_planner": Kit(LOCAL_PLANNERS, local_planners.CHECKS),
    "global_planner": Kit(GLOBAL_PLANNERS, global_planners.CHECKS),
    "recovery_behavior": Kit(RECOVERIES, recoveries.CHECKS),
    "costmap_layer": Kit(LAYERS, layers.CHECKS),
}
