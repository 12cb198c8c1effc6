"""The dynamic window approach: dwa_local_planner, also under the names of TrajectoryPlannerROS."""

from move_base_lite.control.dwa.planner import DwaPlanner
from move_base_lite.control.dwa.settings import (
    DWA_WITHOUT_EFFECT,
    TRAJECTORY_WITHOUT_EFFECT,
    DwaSettings,
    TrajectorySettings,
)
from move_base_lite.control.local_planner import LocalPlanner
from planar.extensions import Plugin

DWA: Plugin[LocalPlanner] = Plugin(
    "dwa_local_planner/DWAPlannerROS",
    DwaSettings,
    DwaPlanner,
    deprecated={
        "max_trans_vel": "max_vel_trans",
        "min_trans_vel": "min_vel_trans",
        "max_rot_vel": "max_vel_theta",
        "min_rot_vel": "min_vel_theta",
        "rot_stopped_vel": "theta_stopped_vel",
        "acc_limit_trans": "acc_lim_trans",
        "acc_lim_th": "acc_lim_theta",
        "vtheta_samples": "vth_samples",
    },
    without_effect=DWA_WITHOUT_EFFECT,
    elsewhere=frozenset({"odom_topic"}),
)

TRAJECTORY: Plugin[LocalPlanner] = Plugin(
    "base_local_planner/TrajectoryPlannerROS",
    TrajectorySettings,
    DwaPlanner,
    synonyms={
        "max_rotational_vel": "max_vel_theta",
        "min_in_place_rotational_vel": "min_in_place_vel_theta",
        "acc_lim_th": "acc_lim_theta",
        "pdist_scale": "path_distance_bias",
        "gdist_scale": "goal_distance_bias",
    },
    without_effect=TRAJECTORY_WITHOUT_EFFECT,
)

__all__ = ["DWA", "TRAJECTORY", "DwaPlanner", "DwaSettings", "TrajectorySettings"]
