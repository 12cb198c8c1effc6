"""Parameters of DWAPlannerROS and TrajectoryPlannerROS."""

from dataclasses import dataclass, field

from move_base_lite.control.settings import OFFERED_FROM_ZERO, OFFERED_TO_20, ControllerSettings
from planar.config.parameters import POSITIVE, DynamicParameter, parameter

SIDEWAYS = "(no effect on a differential drive)"
EXACT = "(no effect: the footprint is exact)"
STEADY = "(no effect: nothing oscillates)"


@dataclass(frozen=True)
class DwaSettings(ControllerSettings):
    """DWAPlannerROS's parameters (Noetic) that mean something here."""

    sim_time: float = parameter(1.7, "that each velocity is followed ahead", "s", POSITIVE, dynamic=True)
    sim_granularity: float = parameter(
        0.025, "between poses checked for collision", "m", POSITIVE, dynamic=True
    )
    angular_sim_granularity: float = parameter(
        0.1, "between poses checked for collision", "rad", POSITIVE, dynamic=True
    )
    vx_samples: int = parameter(3, "speeds tried each period", bounds=POSITIVE, dynamic=(1, float("inf")))
    vth_samples: int = parameter(
        20, "turn rates tried each period", bounds=POSITIVE, dynamic=(1, float("inf"))
    )
    use_dwa: bool = parameter(
        True, "velocities reachable in one period; false: within sim_time", dynamic=True
    )
    path_distance_bias: float = parameter(
        0.6, "weight of the distance to the plan", dynamic=OFFERED_FROM_ZERO
    )
    goal_distance_bias: float = parameter(
        0.8, "weight of the distance to the plan's end", dynamic=OFFERED_FROM_ZERO
    )
    occdist_scale: float = parameter(
        0.01, "weight of the costs under the footprint", dynamic=OFFERED_FROM_ZERO
    )
    twirling_scale: float = parameter(0.0, "weight of turning", dynamic=OFFERED_FROM_ZERO)
    forward_point_distance: float = parameter(
        0.325, "nose of the robot that is to lie on the plan too", "m", dynamic=True
    )
    cheat_factor: float = parameter(
        1.0, "times forward_point_distance (squared) from the end, no alignment", dynamic=True
    )
    publish_traj_pc: bool = parameter(
        False, "whether the ways tried are on trajectory_cloud, while somebody listens", dynamic=True
    )
    publish_cost_grid_pc: bool = parameter(
        False,
        "whether costs are on cost_cloud, while somebody listens; TrajectoryPlannerROS: true",
        dynamic=True,
    )


# In dynamic_reconfigure, of a robot that moves sideways or of details of the official code.
DWA_WITHOUT_EFFECT = (
    DynamicParameter("max_vel_y", 0.1, f"[m/s] {SIDEWAYS}"),
    DynamicParameter("min_vel_y", -0.1, f"[m/s] {SIDEWAYS}"),
    DynamicParameter("acc_lim_y", 2.5, f"[m/s^2] {SIDEWAYS}", 0.0, 20.0),
    DynamicParameter("acc_lim_trans", 0.1, f"[m/s^2] {SIDEWAYS}", 0.0, 20.0),
    DynamicParameter("vy_samples", 10, SIDEWAYS, 1),
    DynamicParameter("prune_plan", False, "(no effect: what lies behind the robot is always left out)"),
    DynamicParameter("stop_time_buffer", 0.2, "[s] (no effect)", 0.0),
    DynamicParameter("oscillation_reset_dist", 0.05, f"[m] {STEADY}", 0.0),
    DynamicParameter("oscillation_reset_angle", 0.2, f"[rad] {STEADY}", 0.0),
    DynamicParameter("scaling_speed", 0.25, f"[m/s] {EXACT}", 0.0),
    DynamicParameter("max_scaling_factor", 0.2, EXACT, 0.0),
)
# Known beside them: read by the official code and never used, or of no meaning here.
DWA_IGNORED = frozenset(
    {
        "global_frame_id", "sum_scores", "odom_topic", "holonomic_robot", "restore_defaults",
        "controller_frequency", "penalize_negative_x",
    }
)  # fmt: skip


@dataclass(frozen=True)
class TrajectorySettings(DwaSettings):
    """The parameters of TrajectoryPlannerROS (Noetic) that mean something here, by its names and defaults.

    It has no limit of its own on the length of the velocity, and turns to the path as DWA does by default.
    """

    max_vel_trans: float = field(default=0.5, init=False)
    heading_lookahead: float = field(default=0.4, init=False)
    max_vel_x: float = parameter(0.5, "highest speed ahead", "m/s", dynamic=(0.0, 20.0))
    min_vel_x: float = parameter(0.1, "lowest speed ahead", "m/s", dynamic=(0.0, 20.0))
    max_vel_theta: float = parameter(1.0, "highest turn rate", "rad/s", POSITIVE, dynamic=OFFERED_TO_20)
    min_vel_theta: float = parameter(
        0.4,
        "slower the robot does not turn on the spot",
        "rad/s",
        name="min_in_place_vel_theta",
        dynamic=(0.0, 20.0),
    )
    yaw_goal_tolerance: float = 0.05
    sim_time: float = 1.0
    vx_samples: int = parameter(3, "speeds tried each period", bounds=POSITIVE, dynamic=(1, 300))
    vth_samples: int = parameter(
        20, "turn rates tried each period", bounds=POSITIVE, name="vtheta_samples", dynamic=(1, 300)
    )
    forward_point_distance: float = parameter(
        0.325,
        "nose of the robot that is to lie on the plan too",
        "m",
        name="heading_lookahead",
        dynamic=(0.0, 5.0),
    )
    use_dwa: bool = parameter(
        True, "velocities reachable in one period; false: within sim_time", name="dwa", dynamic=True
    )
    publish_cost_grid_pc: bool = True

    def __post_init__(self):
        object.__setattr__(self, "max_vel_trans", self.max_vel_x)
        super().__post_init__()


TRAJECTORY_WITHOUT_EFFECT = (
    DynamicParameter("acc_lim_y", 2.5, f"[m/s^2] {SIDEWAYS}", 0.0, 20.0),
    DynamicParameter("stop_time_buffer", 0.2, "[s] (no effect)", 0.0),
    DynamicParameter("oscillation_reset_dist", 0.05, f"[m] {STEADY}", 0.0),
)
TRAJECTORY_IGNORED = (
    DWA_IGNORED
    | {tunable.name for tunable in DWA_WITHOUT_EFFECT}
    | {
        "escape_vel", "y_vels", "heading_scoring", "heading_scoring_timestep", "meter_scoring",
        "escape_reset_dist", "escape_reset_theta", "simple_attractor", "world_model", "backup_vel",
        "min_vel_theta", "max_vel_trans",
    }
)  # fmt: skip
