"""Settings of the local planners: DWAPlannerROS's parameters, and what makes it dependable."""

from dataclasses import dataclass

from planar.config.settings import check


@dataclass(frozen=True)
class ControllerSettings:
    """What every local planner needs; names, defaults and meaning of DWAPlannerROS (Noetic).

    Metres, seconds, radians. Beyond it: ``rotate_to_path_angle``, the error of heading above which the robot
    first turns on the spot (0 never); ``heading_lookahead``, how far along the plan that heading is taken.
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
    rotate_to_path_angle: float = 0.9
    heading_lookahead: float = 0.4

    @property
    def looks_for_movers(self) -> bool:
        """Whether it matters what moves."""
        return False

    def __post_init__(self):
        for name in (
            "max_vel_trans",
            "max_vel_theta",
            "acc_lim_x",
            "acc_lim_theta",
            "xy_goal_tolerance",
            "yaw_goal_tolerance",
        ):
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


@dataclass(frozen=True)
class DwaSettings(ControllerSettings):
    """DWAPlannerROS's own: metres, seconds, radians.

    ``publish_traj_pc``, ``publish_cost_grid_pc``: whether the trajectories tried, and the costs of the cells
    that they lead through, are shown.
    """

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
    publish_traj_pc: bool = False
    publish_cost_grid_pc: bool = False

    def __post_init__(self):
        super().__post_init__()
        for name in ("sim_time", "sim_granularity", "angular_sim_granularity", "vx_samples", "vth_samples"):
            check(getattr(self, name) > 0, name, "positive", getattr(self, name))


@dataclass(frozen=True)
class MppiSettings(ControllerSettings):
    """Model predictive path integral control: metres, seconds, radians.

    ``horizon``: seconds looked ahead, with ``samples`` ways of driving, drawn from ``seed``. ``noise_vel_x``,
    ``noise_vel_theta``: standard deviations of the speeds tried. ``temperature``: metres that a way may be
    worse than the best and still count. ``safe_distance``: clearance below which it is dear to drive;
    ``approach_time``: the robot is no faster than takes so many seconds to cover its clearance, but never
    slower than ``creep_vel_x``. The weights of nearness, turning, driving backwards, an end that faces away
    from the goal, and delay are of costs counted in metres left to drive. ``predict_movers``: whether people
    and all that moves are expected where they will be by then, instead of where they are seen.
    """

    min_vel_x: float = -0.3
    rotate_to_path_angle: float = 1.6
    horizon: float = 2.0
    samples: int = 600
    noise_vel_x: float = 0.3
    noise_vel_theta: float = 0.8
    temperature: float = 0.05
    safe_distance: float = 0.15
    approach_time: float = 0.25
    creep_vel_x: float = 0.3
    obstacle_weight: float = 2.0
    turn_weight: float = 0.02
    backward_weight: float = 1.0
    heading_weight: float = 0.2
    delay_weight: float = 0.5
    predict_movers: bool = True
    seed: int = 0

    def __post_init__(self):
        super().__post_init__()
        for name in ("horizon", "samples", "noise_vel_x", "noise_vel_theta", "temperature", "creep_vel_x"):
            check(getattr(self, name) > 0, name, "positive", getattr(self, name))
        weights = [f"{name}_weight" for name in ("obstacle", "turn", "backward", "heading", "delay")]
        for name in ("safe_distance", "approach_time", *weights):
            check(getattr(self, name) >= 0, name, "at least 0", getattr(self, name))

    @property
    def looks_for_movers(self) -> bool:
        return self.predict_movers
