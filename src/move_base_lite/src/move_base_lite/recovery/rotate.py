"""Looking around (rotate_recovery)."""

import math
from dataclasses import dataclass
from typing import Optional

from move_base_lite.plugin import Plugin
from move_base_lite.recovery.behavior import RecoveryBehavior, RecoveryContext
from planar import Twist2, wrap
from planar.config.parameters import POSITIVE, check_parameters, parameter

LOOKAHEAD_ANGLE = 0.4
# Radians that it is told to turn, and the share of them that it turns at least, or it cannot.
TOLD_ANGLE, TURNED_SHARE = 1.5, 0.1


@dataclass(frozen=True)
class RotateSettings:
    """Read from TrajectoryPlannerROS, as rotate_recovery does."""

    acc_lim_theta: float = parameter(3.2, "highest acceleration of turning", "rad/s^2", POSITIVE)
    max_vel_theta: float = parameter(1.0, "highest turn rate", "rad/s", POSITIVE)
    min_in_place_vel_theta: float = parameter(0.4, "lowest turn rate", "rad/s")
    yaw_goal_tolerance: float = parameter(0.1, "what may be left of the full turn", "rad")

    def __post_init__(self):
        check_parameters(self)


class RotateRecovery(RecoveryBehavior):
    """One full turn to the left to look around.

    Ends early if the footprint would touch something, or if the robot does not turn: the official one then
    never ends.
    """

    def __init__(self, settings: RotateSettings):
        self._settings = settings
        self._last_yaw: Optional[float] = None
        self._left = self._left_before = 2.0 * math.pi
        self._told = 0.0

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        settings, base = self._settings, context.base_in_local
        if self._last_yaw is not None:
            self._left -= wrap(base.yaw - self._last_yaw)
        self._last_yaw = base.yaw
        if self._left <= settings.yaw_goal_tolerance:
            return None
        if self._is_stuck():
            return None
        if not context.local_costmap.has_room_to_turn(base, min(LOOKAHEAD_ANGLE, self._left)):
            return None
        stoppable = math.sqrt(2.0 * settings.acc_lim_theta * self._left)
        speed = min(max(stoppable, settings.min_in_place_vel_theta), settings.max_vel_theta)
        command = Twist2(0.0, min(speed, context.twist.omega + settings.acc_lim_theta * context.period))
        self._told += command.omega * context.period
        return command

    def _is_stuck(self) -> bool:
        """Whether it has hardly turned for all that it was told to; asked anew after that."""
        if self._told < TOLD_ANGLE:
            return False
        turned = self._left_before - self._left
        is_stuck = turned < TURNED_SHARE * self._told
        self._told, self._left_before = 0.0, self._left
        return is_stuck


ROTATE: Plugin[RecoveryBehavior] = Plugin(
    "rotate_recovery/RotateRecovery",
    RotateSettings,
    RotateRecovery,
    synonyms={
        "acc_lim_th": "acc_lim_theta",
        "max_rotational_vel": "max_vel_theta",
        "min_in_place_rotational_vel": "min_in_place_vel_theta",
    },
    ignored=frozenset({"sim_granularity", "frequency"}),
)
