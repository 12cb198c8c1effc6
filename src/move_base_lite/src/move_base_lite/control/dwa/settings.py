"""Parameters of DWAPlannerROS and TrajectoryPlannerROS."""

import math
from dataclasses import dataclass, field, replace

from move_base_lite.control.settings import OFFERED_FROM_ZERO, OFFERED_TO_20, ControllerSettings
from planar.config.parameters import POSITIVE, parameter
from planar.config.without_effect import IneffectiveParameter

# Reasons for parameters that are accepted without effect.
SIDEWAYS = "the drive is differential"
EXACT = "the footprint is exact"
STEADY = "oscillations are not tracked"
ESCAPE = "trapped robots escape by costs"
PRUNED = "the plan behind the robot is always pruned"
UNREAD = "the official planner does not read it"


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


DWA_WITHOUT_EFFECT = (
    IneffectiveParameter("max_vel_y", 0.1, SIDEWAYS, fulfilled=(0,)),
    IneffectiveParameter("min_vel_y", -0.1, SIDEWAYS, fulfilled=(0,)),
    IneffectiveParameter("acc_lim_y", 2.5, SIDEWAYS, 0.0, 20.0, fulfilled=(0,)),
    IneffectiveParameter("acc_lim_trans", 0.1, "acc_lim_x limits the acceleration", 0.0, 20.0),
    IneffectiveParameter("vy_samples", 10, SIDEWAYS, 1, fulfilled=(0, 1)),
    IneffectiveParameter("prune_plan", False, PRUNED, fulfilled=(True,)),
    IneffectiveParameter("stop_time_buffer", 0.2, "the official planner does not use it either", 0.0),
    IneffectiveParameter("oscillation_reset_dist", 0.05, STEADY, 0.0),
    IneffectiveParameter("oscillation_reset_angle", 0.2, STEADY, 0.0),
    IneffectiveParameter("scaling_speed", 0.25, EXACT, 0.0),
    IneffectiveParameter("max_scaling_factor", 0.2, EXACT, 0.0),
    IneffectiveParameter(
        "global_frame_id", "odom", "clouds are in the frame of the local costmap", is_dynamic=False
    ),
    IneffectiveParameter("sum_scores", False, "scores are not summed along a trajectory", is_dynamic=False),
    IneffectiveParameter("controller_frequency", 20.0, "that of move_base applies", is_dynamic=False),
    IneffectiveParameter("penalize_negative_x", True, UNREAD, is_dynamic=False),
    IneffectiveParameter("holonomic_robot", False, SIDEWAYS, is_dynamic=False),
)


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


_OFFERED = ("acc_lim_y", "stop_time_buffer", "oscillation_reset_dist")
_OWN = (
    IneffectiveParameter("holonomic_robot", True, SIDEWAYS, fulfilled=(False,), is_dynamic=False),
    IneffectiveParameter("prune_plan", True, PRUNED, is_dynamic=False),
    IneffectiveParameter("odom_topic", "odom", UNREAD, is_dynamic=False),
    IneffectiveParameter("escape_vel", -0.1, ESCAPE, is_dynamic=False),
    IneffectiveParameter("backup_vel", -0.1, ESCAPE, is_dynamic=False),
    IneffectiveParameter("escape_reset_dist", 0.1, ESCAPE, is_dynamic=False),
    IneffectiveParameter("escape_reset_theta", math.pi / 4, ESCAPE, is_dynamic=False),
    IneffectiveParameter("y_vels", [-0.3, -0.1, 0.1, 0.3], SIDEWAYS, fulfilled=([],), is_dynamic=False),
    IneffectiveParameter("heading_scoring", False, "DWA's critics score headings", is_dynamic=False),
    IneffectiveParameter("heading_scoring_timestep", 0.8, "DWA's critics score headings", is_dynamic=False),
    IneffectiveParameter("meter_scoring", False, "distances are scored as by DWA", is_dynamic=False),
    IneffectiveParameter("simple_attractor", False, "DWA's critics score trajectories", is_dynamic=False),
    IneffectiveParameter("world_model", "costmap", "collisions are checked in the costmap", is_dynamic=False),
    IneffectiveParameter("min_vel_theta", -1.0, "the turn rate is at least -max_vel_theta", is_dynamic=False),
    IneffectiveParameter("max_vel_trans", 0.55, "max_vel_x is the maximum speed", is_dynamic=False),
)
TRAJECTORY_WITHOUT_EFFECT = (
    *_OWN,
    *(
        replace(each, is_dynamic=each.name in _OFFERED)
        for each in DWA_WITHOUT_EFFECT
        if each.name not in {own.name for own in _OWN}
    ),
)
