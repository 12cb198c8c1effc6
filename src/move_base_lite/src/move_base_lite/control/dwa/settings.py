"""Parameters of DWAPlannerROS and TrajectoryPlannerROS."""

from dataclasses import dataclass, field

from move_base_lite.control.settings import OFFERED_FROM_ZERO, OFFERED_TO_20, ControllerSettings
from planar.config.parameters import POSITIVE, DynamicParameter, parameter

SIDEWAYS = "(no effect on a differential drive)"
EXACT = "(no effect: the footprint is exact)"
STEADY = "(no effect: oscillations are not tracked)"


@dataclass(frozen=True)
class DwaSettings(ControllerSettings):
    """Parameters of DWAPlannerROS (Noetic) that have an effect here."""

    sim_time: float = parameter(1.7, "time that each velocity is simulated", "s", POSITIVE, dynamic=True)
    sim_granularity: float = parameter(
        0.025, "spacing of the poses checked for collision", "m", POSITIVE, dynamic=True
    )
    angular_sim_granularity: float = parameter(
        0.1, "spacing of the poses checked for collision", "rad", POSITIVE, dynamic=True
    )
    vx_samples: int = parameter(3, "speeds sampled each period", bounds=POSITIVE, dynamic=(1, float("inf")))
    vth_samples: int = parameter(
        20, "turn rates sampled each period", bounds=POSITIVE, dynamic=(1, float("inf"))
    )
    use_dwa: bool = parameter(
        True, "sample velocities reachable within one period; false: within sim_time", dynamic=True
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
        0.325, "distance of the forward point that is scored too", "m", dynamic=True
    )
    cheat_factor: float = parameter(
        1.0,
        "no alignment within forward_point_distance times its square root of the plan's end",
        dynamic=True,
    )
    publish_traj_pc: bool = parameter(
        False, "publish the sampled trajectories on trajectory_cloud if it has subscribers", dynamic=True
    )
    publish_cost_grid_pc: bool = parameter(
        False,
        "publish the cell costs on cost_cloud if it has subscribers; TrajectoryPlannerROS: true",
        dynamic=True,
    )


# Offered by dynamic_reconfigure without effect: for holonomic robots, or details of the official code.
DWA_WITHOUT_EFFECT = (
    DynamicParameter("max_vel_y", 0.1, f"[m/s] {SIDEWAYS}"),
    DynamicParameter("min_vel_y", -0.1, f"[m/s] {SIDEWAYS}"),
    DynamicParameter("acc_lim_y", 2.5, f"[m/s^2] {SIDEWAYS}", 0.0, 20.0),
    DynamicParameter("acc_lim_trans", 0.1, f"[m/s^2] {SIDEWAYS}", 0.0, 20.0),
    DynamicParameter("vy_samples", 10, SIDEWAYS, 1),
    DynamicParameter("prune_plan", False, "(no effect: the plan behind the robot is always pruned)"),
    DynamicParameter("stop_time_buffer", 0.2, "[s] (no effect)", 0.0),
    DynamicParameter("oscillation_reset_dist", 0.05, f"[m] {STEADY}", 0.0),
    DynamicParameter("oscillation_reset_angle", 0.2, f"[rad] {STEADY}", 0.0),
    DynamicParameter("scaling_speed", 0.25, f"[m/s] {EXACT}", 0.0),
    DynamicParameter("max_scaling_factor", 0.2, EXACT, 0.0),
)
# Accepted without effect: unused in the official code, or meaningless here.
DWA_IGNORED = frozenset(
    {
        "global_frame_id", "sum_scores", "odom_topic", "holonomic_robot", "restore_defaults",
        "controller_frequency", "penalize_negative_x",
    }
)  # fmt: skip


@dataclass(frozen=True)
class TrajectorySettings(DwaSettings):
    """Parameters of TrajectoryPlannerROS (Noetic) that have an effect here, with its names and defaults.

    It has no ``max_vel_trans``, and turns towards the plan as DWA does by default.
    """

    max_vel_trans: float = field(default=0.5, init=False)
    heading_lookahead: float = field(default=0.4, init=False)
    max_vel_x: float = parameter(0.5, "maximum forward speed", "m/s", dynamic=(0.0, 20.0))
    min_vel_x: float = parameter(0.1, "minimum forward speed", "m/s", dynamic=(0.0, 20.0))
    max_vel_theta: float = parameter(1.0, "maximum turn rate", "rad/s", POSITIVE, dynamic=OFFERED_TO_20)
    min_vel_theta: float = parameter(
        0.4,
        "minimum turn rate when turning in place",
        "rad/s",
        name="min_in_place_vel_theta",
        dynamic=(0.0, 20.0),
    )
    yaw_goal_tolerance: float = 0.05
    sim_time: float = 1.0
    vx_samples: int = parameter(3, "speeds sampled each period", bounds=POSITIVE, dynamic=(1, 300))
    vth_samples: int = parameter(
        20, "turn rates sampled each period", bounds=POSITIVE, name="vtheta_samples", dynamic=(1, 300)
    )
    forward_point_distance: float = parameter(
        0.325,
        "distance of the forward point that is scored too",
        "m",
        name="heading_lookahead",
        dynamic=(0.0, 5.0),
    )
    use_dwa: bool = parameter(
        True,
        "sample velocities reachable within one period; false: within sim_time",
        name="dwa",
        dynamic=True,
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
