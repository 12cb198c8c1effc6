"""The recovery behaviours that there are. To add one is to add it here."""

from move_base_lite.plugin import Registry
from move_base_lite.recovery.behavior import RecoveryBehavior, RecoverySettings
from move_base_lite.recovery.clear_costmap import CLEAR_COSTMAP
from move_base_lite.recovery.guarded import GuardedRecovery
from move_base_lite.recovery.move_slow import MOVE_SLOW
from move_base_lite.recovery.rotate import ROTATE
from planar.plugins import PluginContract

RECOVERIES: Registry[RecoveryBehavior] = Registry(
    CLEAR_COSTMAP,
    ROTATE,
    MOVE_SLOW,
    contract=PluginContract(
        "recovery behaviour", RecoveryBehavior, RecoverySettings, "move_base_lite.recovery_behaviors"
    ),
    guarded=GuardedRecovery,
)
