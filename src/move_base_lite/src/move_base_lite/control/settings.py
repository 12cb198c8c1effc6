"""Settings of the local planner: DWAPlannerROS's parameters, and what makes it dependable."""

from dataclasses import dataclass

from planar.settings import check


@dataclass(frozen=True)
class DwaSettings:
    """Names, defaults and meaning of DWAPlannerROS (Noetic); metres, seconds, radians.

    Beyond it: ``rotate_to_path_angle``, the error of heading above which the robot first turns on the spot
    (0 never); ``heading_lookahead``, how far along the plan that heading is taken.
    """

    max_vel_trans: float = 0.55
    min_vel_trans: float = 0.1
    max_vel_x: float = 0.55
    min_vel_x: float = 0.0
    max_vel_theta: float = 1.0
    min_vel_theta: float = 0.4
    acc_lim_x: float = 2.5
    acc_lim_theta: float = 3.2
    xy_goal_tolerance: float = 0.1
    yaw_goal_tolerance: float = 0.1
    latch_xy_goal_tolerance: bool = False
    trans_stopped_vel: float = 0.1
    theta_stopped_vel: float = 0.1
    sim_time: float = 1.7
    sim_granularity: float = 0.025
    angular_sim_granularity: float = 0.1
    vx_samples: int = 3
    vth_samples: int = 20
    use_dwa: bool = True
    path_distance_bias: float = 0.6
    goal_distance_bias: float = 0.8
    occdist_scale: float = 0.01
    twirling_scale: float = 0.0
    forward_point_distance: float = 0.325
    cheat_factor: float = 1.0
    rotate_to_path_angle: float = 0.9
    heading_lookahead: float = 0.4

    def __post_init__(self):
        positive = (
            "max_vel_trans",
            "max_vel_theta",
            "acc_lim_x",
            "acc_lim_theta",
            "xy_goal_tolerance",
            "yaw_goal_tolerance",
            "sim_time",
            "sim_granularity",
            "angular_sim_granularity",
            "vx_samples",
            "vth_samples",
        )
        for name in positive:
            check(getattr(self, name) > 0, name, "positive", getattr(self, name))
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
