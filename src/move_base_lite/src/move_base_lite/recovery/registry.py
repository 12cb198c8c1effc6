"""The recovery behaviours that there are. To add one is to add it here."""

from move_base_lite.plugin import Registry
from move_base_lite.recovery.behavior import RecoveryBehavior
from move_base_lite.recovery.clear_costmap import CLEAR_COSTMAP
from move_base_lite.recovery.move_slow import MOVE_SLOW
from move_base_lite.recovery.rotate import ROTATE

RECOVERIES: Registry[RecoveryBehavior] = Registry(
    CLEAR_COSTMAP,
    ROTATE,
    MOVE_SLOW,
)
