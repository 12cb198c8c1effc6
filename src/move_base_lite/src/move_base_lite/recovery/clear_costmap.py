"""Clear costmap recovery (clear_costmap_recovery)."""

from dataclasses import dataclass
from typing import Optional, Tuple

from move_base_lite.recovery.behavior import RecoveryBehavior, RecoveryContext
from planar import Twist2
from planar.config.parameters import at_least, check_parameters, parameter
from planar.config.settings import check
from planar.config.without_effect import IneffectiveParameter
from planar.extensions import Plugin

LOCAL, GLOBAL, BOTH = "local", "global", "both"


@dataclass(frozen=True)
class ClearCostmapSettings:
    """Parameters of clear_costmap_recovery."""

    reset_distance: float = parameter(
        3.0,
        "side of the square around the robot outside of which obstacles are cleared",
        "m",
        at_least(0.0),
    )
    invert_area_to_clear: bool = parameter(False, "clear inside the square instead of outside")
    affected_maps: str = parameter(BOTH, "costmaps to clear: local, global or both")
    layer_names: Tuple[str, ...] = parameter((), "layers to clear; empty: all")

    def __post_init__(self):
        check_parameters(self)
        maps = self.affected_maps
        check(maps in (LOCAL, GLOBAL, BOTH), "affected_maps", "local, global or both", maps)


class ClearCostmapRecovery(RecoveryBehavior):
    """Clears obstacles outside or inside a square around the robot; sensors mark again what exists."""

    def __init__(self, settings: ClearCostmapSettings):
        self._settings = settings

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        """Clear the costmaps, in one period (see RecoveryBehavior.step)."""
        side, affected = self._settings.reset_distance, self._settings.affected_maps
        names = self._settings.layer_names or None
        for name, costmap, base in (
            (GLOBAL, context.global_costmap, context.base_in_map),
            (LOCAL, context.local_costmap, context.base_in_local),
        ):
            if affected in (name, BOTH):
                clear = costmap.clear_around if self._settings.invert_area_to_clear else costmap.clear_outside
                clear(base, side, names)
        return None


CLEAR_COSTMAP: Plugin[RecoveryBehavior] = Plugin(
    "clear_costmap_recovery/ClearCostmapRecovery",
    ClearCostmapSettings,
    ClearCostmapRecovery,
    without_effect=(
        IneffectiveParameter(
            "force_updating", False, "costmaps are updated at once", fulfilled=(True,), is_dynamic=False
        ),
    ),
)
