"""Looking around (rotate_recovery)."""

import math
from dataclasses import dataclass
from typing import Optional

from move_base_lite.plugin import Plugin
from move_base_lite.recovery.behavior import RecoveryBehavior, RecoveryContext
from planar import Twist2, wrap
from planar.config.parameters import POSITIVE, check_parameters, parameter

LOOKAHEAD_ANGLE = 0.4


@dataclass(frozen=True)
class RotateSettings:
    """Read from TrajectoryPlannerROS, as rotate_recovery does."""

    acc_lim_theta: float = parameter(3.2, "highest acceleration of turning", "rad/s^2", POSITIVE)
    max_vel_theta: float = parameter(1.0, "highest turn rate", "rad/s", POSITIVE)
    min_in_place_vel_theta: float = parameter(0.4, "lowest turn rate", "rad/s")
    yaw_goal_tolerance: float = parameter(0.1, "what may be left of the full turn", "rad")

    def __post_init__(self):
        check_parameters(self)


class Rotate(RecoveryBehavior):
    """One full turn to the left to look around; ends early if the footprint would touch something."""

    def __init__(self, settings: RotateSettings):
        self._settings = settings
        self._last_yaw: Optional[float] = None
        self._left = 2.0 * math.pi

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        settings, base = self._settings, context.base_in_local
        if self._last_yaw is not None:
            self._left -= wrap(base.yaw - self._last_yaw)
        self._last_yaw = base.yaw
        if self._left <= settings.yaw_goal_tolerance:
            return None
        if not context.local_costmap.has_room_to_turn(base, min(LOOKAHEAD_ANGLE, self._left)):
            return None
        stoppable = math.sqrt(2.0 * settings.acc_lim_theta * self._left)
        speed = min(max(stoppable, settings.min_in_place_vel_theta), settings.max_vel_theta)
        return Twist2(0.0, min(speed, context.twist.omega + settings.acc_lim_theta * context.period))


ROTATE: Plugin[RecoveryBehavior] = Plugin(
    "rotate_recovery/RotateRecovery",
    RotateSettings,
    Rotate,
    synonyms={
        "acc_lim_th": "acc_lim_theta",
        "max_rotational_vel": "max_vel_theta",
        "min_in_place_rotational_vel": "min_in_place_vel_theta",
    },
    ignored=frozenset({"sim_granularity", "frequency"}),
)
