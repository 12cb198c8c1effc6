"""Model predictive path integral control, the local planner of the shipped configurations."""

from move_base_lite.control.local_planner import LocalPlanner
from move_base_lite.control.mppi.planner import MppiPlanner
from move_base_lite.control.mppi.settings import MppiSettings
from planar.extensions import Plugin

MPPI: Plugin[LocalPlanner] = Plugin(
    "move_base_lite/MppiPlannerROS",
    MppiSettings,
    MppiPlanner,
    deprecated={
        "mover_weight": "dynamic_obstacle_weight",
        "mover_distance": "dynamic_obstacle_distance",
        "mover_range": "dynamic_obstacle_range",
        "predict_movers": "predict_dynamic_obstacles",
        "watch_what_appears": "track_appearing_obstacles",
        "heed_global_costmap": "use_global_costmap",
    },
)

__all__ = ["MPPI", "MppiPlanner", "MppiSettings"]
