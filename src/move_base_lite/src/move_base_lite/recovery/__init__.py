"""What the robot tries when it finds no plan or no safe velocity.

``behavior.py`` is the contract, ``registry.py`` the list of those that hold it.
"""

from move_base_lite.recovery.behavior import (
    NamedRecovery,
    RecoveryBehavior,
    RecoveryContext,
    RecoverySettings,
    SpeedLimit,
)
from move_base_lite.recovery.clear_costmap import ClearCostmap, ClearCostmapSettings
from move_base_lite.recovery.move_slow import MoveSlow, SlowSettings
from move_base_lite.recovery.registry import RECOVERIES
from move_base_lite.recovery.rotate import Rotate, RotateSettings

__all__ = [
    "RECOVERIES",
    "ClearCostmap",
    "ClearCostmapSettings",
    "MoveSlow",
    "NamedRecovery",
    "RecoveryBehavior",
    "RecoveryContext",
    "RecoverySettings",
    "Rotate",
    "RotateSettings",
    "SlowSettings",
    "SpeedLimit",
]
