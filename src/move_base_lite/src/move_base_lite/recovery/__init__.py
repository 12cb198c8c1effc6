"""Recovery behaviours, which run when there is no plan or no safe velocity.

``behavior.py`` is the contract, RECOVERIES lists the behaviours.
"""

from move_base_lite.recovery.behavior import (
    CONTRACT,
    NamedRecovery,
    RecoveryBehavior,
    RecoveryContext,
    RecoverySettings,
    SpeedLimit,
)
from move_base_lite.recovery.clear_costmap import CLEAR_COSTMAP, ClearCostmapRecovery, ClearCostmapSettings
from move_base_lite.recovery.move_slow import MOVE_SLOW, MoveSlowRecovery, MoveSlowSettings
from move_base_lite.recovery.rotate import ROTATE, RotateRecovery, RotateSettings
from planar.extensions import Registry

RECOVERIES: Registry[RecoveryBehavior] = Registry(CONTRACT, CLEAR_COSTMAP, ROTATE, MOVE_SLOW)

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
