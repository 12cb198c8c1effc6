"""Recovery behaviours, which run when there is no plan or no safe velocity.

``behavior.py`` is the contract, ``registry.py`` lists the behaviours.
"""

from move_base_lite.recovery.behavior import (
    NamedRecovery,
    RecoveryBehavior,
    RecoveryContext,
    RecoverySettings,
    SpeedLimit,
)
from move_base_lite.recovery.clear_costmap import ClearCostmapRecovery, ClearCostmapSettings
from move_base_lite.recovery.move_slow import MoveSlowRecovery, MoveSlowSettings
from move_base_lite.recovery.registry import RECOVERIES
from move_base_lite.recovery.rotate import RotateRecovery, RotateSettings

__all__ = [
    "RECOVERIES",
    "ClearCostmapRecovery",
    "ClearCostmapSettings",
    "MoveSlowRecovery",
    "NamedRecovery",
    "RecoveryBehavior",
    "RecoveryContext",
    "RecoverySettings",
    "RotateRecovery",
    "RotateSettings",
    "MoveSlowSettings",
    "SpeedLimit",
]
