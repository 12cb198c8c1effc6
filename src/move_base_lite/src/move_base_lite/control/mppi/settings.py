"""Parameters of MppiPlannerROS."""

from dataclasses import dataclass
from typing import Optional

from move_base_lite.control.settings import ControllerSettings
from move_base_lite.dynamic_obstacles import TrackerSettings
from planar.config.parameters import POSITIVE, at_least, parameter


@dataclass(frozen=True)
class MppiSettings(ControllerSettings):
    """Settings of model predictive path integral control; costs are in metres of remaining path."""

    min_vel_x: float = -0.3
    rotate_to_path_angle: float = 1.6
    horizon: float = parameter(2.0, "prediction horizon", "s", POSITIVE, dynamic=True)
    samples: int = parameter(600, "control sequences sampled each period", bounds=POSITIVE, dynamic=True)
    noise_vel_x: float = parameter(
        0.3, "standard deviation of the sampled speeds", "m/s", POSITIVE, dynamic=True
    )
    noise_vel_theta: float = parameter(
        0.8, "standard deviation of the sampled turn rates", "rad/s", POSITIVE, dynamic=True
    )
    temperature: float = parameter(
        0.05,
        "cost above the best sample's at which a sample's weight falls to 1/e",
        "m",
        POSITIVE,
        dynamic=True,
    )
    safe_distance: float = parameter(
        0.15, "footprint clearance below which driving costs more", "m", at_least(0.0), dynamic=True
    )
    approach_time: float = parameter(
        0.25,
        "minimum time to cover the remaining clearance",
        "s",
        at_least(0.0),
        dynamic=True,
    )
    creep_vel_x: float = parameter(0.3, "speed allowed at any clearance", "m/s", POSITIVE, dynamic=True)
    obstacle_weight: float = parameter(
        2.0,
        "cost per metre driven in contact with an obstacle, less at a distance",
        bounds=at_least(0.0),
        dynamic=True,
    )
    turn_weight: float = parameter(0.02, "weight of the squared turn rate", "s", at_least(0.0), dynamic=True)
    backward_weight: float = parameter(
        1.0, "cost per metre driven backwards", bounds=at_least(0.0), dynamic=True
    )
    heading_weight: float = parameter(
        0.2, "cost of a final heading away from the goal", "m", at_least(0.0), dynamic=True
    )
    delay_weight: float = parameter(
        0.5, "weight of the remaining path over time", "1/s", at_least(0.0), dynamic=True
    )
    dynamic_obstacle_weight: float = parameter(
        10.0,
        "cost of a collision with a dynamic obstacle, less the later and the less likely it is",
        "m",
        at_least(0.0),
        dynamic=True,
    )
    dynamic_obstacle_distance: float = parameter(
        0.15, "clearance from dynamic obstacles below which driving costs more", "m", POSITIVE, dynamic=True
    )
    dynamic_obstacle_range: float = parameter(
        4.0, "range within which dynamic obstacles are tracked", "m", POSITIVE, dynamic=True
    )
    track_appearing_obstacles: bool = parameter(
        False,
        "also track objects that come into view from behind others: for open ground; in a home, some "
        "furniture then seems to move",
        dynamic=True,
    )
    use_global_costmap: bool = parameter(
        False,
        "also avoid obstacles that only the global costmap has: for a sensor with a narrow field of view",
        dynamic=True,
    )
    predict_dynamic_obstacles: bool = parameter(
        True,
        "predict people and other dynamic obstacles instead of taking them as static",
        dynamic=True,
    )
    seed: int = parameter(0, "of the sampled noise", dynamic=True)

    @property
    def tracker_settings(self) -> Optional[TrackerSettings]:
        """Settings of the dynamic obstacle tracker, if obstacles are predicted."""
        if not self.predict_dynamic_obstacles:
            return None
        return TrackerSettings(self.dynamic_obstacle_range, self.track_appearing_obstacles)
