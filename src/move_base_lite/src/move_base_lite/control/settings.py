"""What every local planner needs to know; names, defaults and meaning of DWAPlannerROS (Noetic)."""

from dataclasses import dataclass
from typing import Optional

from move_base_lite.people import Lookout
from planar import Twist2
from planar.config.parameters import POSITIVE, check_parameters, parameter
from planar.config.settings import check

OFFERED_FROM_ZERO = (0.0, float("inf"))
OFFERED_TO_20 = 20.0


@dataclass(frozen=True)
class ControllerSettings:
    """The settings of any local planner: limits of speed and acceleration, and what the Controller does."""

    max_vel_trans: float = parameter(0.55, "highest speed", "m/s", POSITIVE, dynamic=True)
    min_vel_trans: float = parameter(
        0.1, "slower the robot neither sets off nor approaches the goal", "m/s", dynamic=OFFERED_FROM_ZERO
    )
    max_vel_x: float = parameter(0.55, "highest speed ahead", "m/s", dynamic=True)
    min_vel_x: float = parameter(0.0, "negative: may drive backwards", "m/s", dynamic=True)
    max_vel_theta: float = parameter(1.0, "highest turn rate", "rad/s", POSITIVE, dynamic=True)
    min_vel_theta: float = parameter(
        0.4, "slower the robot does not turn on the spot", "rad/s", dynamic=OFFERED_FROM_ZERO
    )
    acc_lim_x: float = parameter(2.5, "highest acceleration", "m/s^2", POSITIVE, dynamic=OFFERED_TO_20)
    acc_lim_theta: float = parameter(3.2, "of turning", "rad/s^2", POSITIVE, dynamic=OFFERED_TO_20)
    xy_goal_tolerance: float = parameter(
        0.1, "distance to the goal that is near enough", "m", POSITIVE, dynamic=True
    )
    yaw_goal_tolerance: float = parameter(
        0.1, "angle off the goal's that is near enough", "rad", POSITIVE, dynamic=True
    )
    latch_xy_goal_tolerance: bool = parameter(
        False, "whether a robot that has been within xy_goal_tolerance only turns", dynamic=True
    )
    trans_stopped_vel: float = parameter(
        0.1, "slower the robot counts as standing", "m/s", dynamic=OFFERED_FROM_ZERO
    )
    theta_stopped_vel: float = parameter(
        0.1, "slower the robot counts as standing", "rad/s", dynamic=OFFERED_FROM_ZERO
    )
    rotate_to_path_angle: float = parameter(
        0.9, "error of heading above which the robot first turns on the spot; 0: never", "rad", dynamic=True
    )
    heading_lookahead: float = parameter(
        0.4, "how far along the plan that heading is taken", "m", dynamic=True
    )

    @property
    def lookout(self) -> Optional[Lookout]:
        """How it is looked for what moves; None: it does not matter what does."""
        return None

    def reachable(self, now: Twist2, wanted: Twist2, limits: Twist2, period: float) -> Twist2:
        """The nearest to what is wanted that the robot can do after ``period`` s, within the limits."""
        dv, domega = self.acc_lim_x * period, self.acc_lim_theta * period
        v = min(max(wanted.v, now.v - dv, self.min_vel_x), now.v + dv, limits.v)
        omega = min(max(wanted.omega, now.omega - domega), now.omega + domega)
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
