"""Move slow and clear recovery (move_slow_and_clear)."""

from dataclasses import dataclass
from typing import Optional

from move_base_lite.recovery.behavior import RecoveryBehavior, RecoveryContext, SpeedLimit
from planar import Twist2
from planar.config.parameters import POSITIVE, at_least, check_parameters, parameter
from planar.config.without_effect import IneffectiveParameter
from planar.extensions import Plugin


@dataclass(frozen=True)
class MoveSlowSettings:
    """Parameters of move_slow_and_clear."""

    clearing_distance: float = parameter(0.5, "distance around the robot that is cleared", "m", at_least(0.0))
    limited_trans_speed: float = parameter(0.25, "highest speed", "m/s", POSITIVE)
    limited_rot_speed: float = parameter(0.45, "highest turn rate", "rad/s", POSITIVE)
    limited_distance: float = parameter(0.3, "distance driven at limited speed", "m", at_least(0.0))

    def __post_init__(self):
        check_parameters(self)


class MoveSlowRecovery(RecoveryBehavior):
    """Clears obstacles near the robot and limits its speed for some distance."""

    def __init__(self, settings: MoveSlowSettings):
        self._settings = settings

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        """Clear the costmaps and set the speed limit, in one period (see RecoveryBehavior.step)."""
        settings = self._settings
        context.global_costmap.clear_around(context.base_in_map, 2.0 * settings.clearing_distance)
        context.local_costmap.clear_around(context.base_in_local, 2.0 * settings.clearing_distance)
        highest = Twist2(settings.limited_trans_speed, settings.limited_rot_speed)
        context.limit_speed(SpeedLimit(highest, settings.limited_distance))
        return None


LIMITED = "the limit applies to any local planner"
MOVE_SLOW: Plugin[RecoveryBehavior] = Plugin(
    "move_slow_and_clear/MoveSlowAndClear",
    MoveSlowSettings,
    MoveSlowRecovery,
    without_effect=(
        IneffectiveParameter("max_trans_param_name", "max_trans_vel", LIMITED, is_dynamic=False),
        IneffectiveParameter("max_rot_param_name", "max_rot_vel", LIMITED, is_dynamic=False),
        IneffectiveParameter("planner_namespace", "DWAPlannerROS", LIMITED, is_dynamic=False),
    ),
)
