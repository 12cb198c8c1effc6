"""What the robot tries when it finds no plan or no safe velocity."""

from move_base_lite.recovery.behaviors import (
    ClearCostmap,
    Recovery,
    RecoveryContext,
    RecoverySettings,
    Rotate,
    RotateSettings,
    SlowSettings,
    SpeedLimit,
    recovery_from,
)

__all__ = [
    "ClearCostmap",
    "Recovery",
    "RecoveryContext",
    "RecoverySettings",
    "Rotate",
    "RotateSettings",
    "SlowSettings",
    "SpeedLimit",
    "recovery_from",
]
