"""Rotate recovery (rotate_recovery)."""

import math
from dataclasses import dataclass
from typing import Optional

from move_base_lite.recovery.behavior import RecoveryBehavior, RecoveryContext
from planar import Twist2, wrap
from planar.config.parameters import POSITIVE, check_parameters, parameter
from planar.config.without_effect import IneffectiveParameter
from planar.extensions import Plugin

LOOKAHEAD_ANGLE = 0.4
# After so much commanded rotation [rad], the robot must have turned by this fraction of it, or it is stuck.
MIN_COMMANDED_ANGLE, MIN_TURNED_FRACTION = 1.5, 0.1


@dataclass(frozen=True)
class RotateSettings:
    """Parameters of rotate_recovery, from the namespace TrajectoryPlannerROS as in the official package."""

    acc_lim_theta: float = parameter(3.2, "highest acceleration of turning", "rad/s^2", POSITIVE)
    max_vel_theta: float = parameter(1.0, "highest turn rate", "rad/s", POSITIVE)
    min_in_place_vel_theta: float = parameter(0.4, "lowest turn rate", "rad/s")
    yaw_goal_tolerance: float = parameter(0.1, "rotation that may remain of the full turn", "rad")

    def __post_init__(self):
        check_parameters(self)


class RotateRecovery(RecoveryBehavior):
    """Rotates in place by one full turn to the left, so that the sensors cover all directions.

    It ends early if the footprint would collide, or if the robot does not turn (rotate_recovery never ends
    then).
    """

    def __init__(self, settings: RotateSettings):
        self._settings = settings
        self._last_yaw: Optional[float] = None
        self._remaining = self._remaining_at_check = 2.0 * math.pi
        self._commanded = 0.0

    def step(self, context: RecoveryContext) -> Optional[Twist2]:
        """Command the next part of the turn (see RecoveryBehavior.step)."""
        settings, base = self._settings, context.base_in_local
        if self._last_yaw is not None:
            self._remaining -= wrap(base.yaw - self._last_yaw)
        self._last_yaw = base.yaw
        if self._remaining <= settings.yaw_goal_tolerance:
            return None
        if self._is_stuck():
            return None
        if not context.local_costmap.has_room_to_turn(base, min(LOOKAHEAD_ANGLE, self._remaining)):
            return None
        stopping_rate = math.sqrt(2.0 * settings.acc_lim_theta * self._remaining)
        speed = min(max(stopping_rate, settings.min_in_place_vel_theta), settings.max_vel_theta)
        command = Twist2(0.0, min(speed, context.twist.omega + settings.acc_lim_theta * context.period))
        self._commanded += command.omega * context.period
        return command

    def _is_stuck(self) -> bool:
        """Whether the robot has hardly turned for the commanded rotation since the last check."""
        if self._commanded < MIN_COMMANDED_ANGLE:
            return False
        turned = self._remaining_at_check - self._remaining
        is_stuck = turned < MIN_TURNED_FRACTION * self._commanded
        self._commanded, self._remaining_at_check = 0.0, self._remaining
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
    without_effect=(
        IneffectiveParameter(
            "sim_granularity", 0.017, "collisions are checked each 0.1 rad", is_dynamic=False
        ),
        IneffectiveParameter("frequency", 20.0, "controller_frequency applies", is_dynamic=False),
    ),
)
