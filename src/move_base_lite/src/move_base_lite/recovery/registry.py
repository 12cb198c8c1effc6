"""Registry of the recovery behaviours."""

from move_base_lite.recovery.behavior import CONTRACT, RecoveryBehavior
from move_base_lite.recovery.clear_costmap import CLEAR_COSTMAP
from move_base_lite.recovery.move_slow import MOVE_SLOW
from move_base_lite.recovery.rotate import ROTATE
from planar.extensions import Registry

RECOVERIES: Registry[RecoveryBehavior] = Registry(CONTRACT, CLEAR_COSTMAP, ROTATE, MOVE_SLOW)
