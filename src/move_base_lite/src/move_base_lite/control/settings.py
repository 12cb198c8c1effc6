"""Settings that all local planners share: names, defaults and meaning of DWAPlannerROS (Noetic)."""

from dataclasses import dataclass
from typing import Optional

from move_base_lite.dynamic_obstacles import TrackerSettings
from planar import Twist2
from planar.config.parameters import POSITIVE, check_parameters, parameter
from planar.config.settings import check

OFFERED_FROM_ZERO = (0.0, float("inf"))
OFFERED_TO_20 = 20.0


@dataclass(frozen=True)
class ControllerSettings:
    """Settings of any local planner: limits of speed and acceleration, and those of the Controller.

    Each field is a parameter; its meaning, unit and bounds are in its ``parameter(...)``.
    """

    max_vel_trans: float = parameter(0.55, "maximum speed", "m/s", POSITIVE, dynamic=True)
    min_vel_trans: float = parameter(
        0.1, "minimum speed when starting and when approaching the goal", "m/s", dynamic=OFFERED_FROM_ZERO
    )
    max_vel_x: float = parameter(0.55, "maximum forward speed", "m/s", dynamic=True)
    min_vel_x: float = parameter(0.0, "minimum speed; negative: may drive backwards", "m/s", dynamic=True)
    max_vel_theta: float = parameter(1.0, "maximum turn rate", "rad/s", POSITIVE, dynamic=True)
    min_vel_theta: float = parameter(
        0.4, "minimum turn rate when turning in place", "rad/s", dynamic=OFFERED_FROM_ZERO
    )
    acc_lim_x: float = parameter(2.5, "maximum acceleration", "m/s^2", POSITIVE, dynamic=OFFERED_TO_20)
    acc_lim_theta: float = parameter(
        3.2, "maximum angular acceleration", "rad/s^2", POSITIVE, dynamic=OFFERED_TO_20
    )
    xy_goal_tolerance: float = parameter(0.1, "tolerance of the goal position", "m", POSITIVE, dynamic=True)
    yaw_goal_tolerance: float = parameter(0.1, "tolerance of the goal heading", "rad", POSITIVE, dynamic=True)
    latch_xy_goal_tolerance: bool = parameter(
        False, "once within xy_goal_tolerance, only turn to the goal heading", dynamic=True
    )
    trans_stopped_vel: float = parameter(
        0.1, "speed below which the robot counts as stopped", "m/s", dynamic=OFFERED_FROM_ZERO
    )
    theta_stopped_vel: float = parameter(
        0.1, "turn rate below which the robot counts as stopped", "rad/s", dynamic=OFFERED_FROM_ZERO
    )
    rotate_to_path_angle: float = parameter(
        0.9, "heading error above which the robot first turns in place; 0: never", "rad", dynamic=True
    )
    heading_lookahead: float = parameter(
        0.4, "distance along the plan at which its heading is taken", "m", dynamic=True
    )

    @property
    def tracker_settings(self) -> Optional[TrackerSettings]:
        """Settings of the dynamic obstacle tracker; None if obstacles are not tracked."""
        return getattr(self, "lookout", None)  # deprecated name, which a custom planner's settings may have

    def reachable(self, now: Twist2, target: Twist2, limits: Twist2, period: float) -> Twist2:
        """Clip a velocity to what the acceleration limits allow.

        Args:
            now: Present velocity.
            target: Requested velocity.
            limits: Maximum speeds [m/s, rad/s].
            period: Time in which it is to be reached [s].

        Returns:
            The reachable velocity nearest to ``target``.
        """
        dv, domega = self.acc_lim_x * period, self.acc_lim_theta * period
        v = min(max(target.v, now.v - dv, self.min_vel_x), now.v + dv, limits.v)
        omega = min(max(target.omega, now.omega - domega), now.omega + domega)
        return Twist2(v, min(max(omega, -limits.omega), limits.omega))

    def __post_init__(self):
        check_parameters(self)
        check(
            self.max_vel_x >= self.min_vel_x,
            "max_vel_x",
            f"at least min_vel_x ({self.min_vel_x})",
            self.max_vel_x,
        )
        check(
            self.min_vel_theta <= self.max_vel_theta,
            "min_vel_theta",
            "at most max_vel_theta",
            self.min_vel_theta,
        )
