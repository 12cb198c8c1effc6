"""Parameters of MppiPlannerROS."""

from dataclasses import dataclass
from typing import Optional

from move_base_lite.control.settings import ControllerSettings
from move_base_lite.people import Lookout
from planar.config.parameters import POSITIVE, at_least, parameter


@dataclass(frozen=True)
class MppiSettings(ControllerSettings):
    """Model predictive path integral control; costs are counted in metres left to drive."""

    min_vel_x: float = -0.3
    rotate_to_path_angle: float = 1.6
    horizon: float = parameter(2.0, "looked ahead", "s", POSITIVE, dynamic=True)
    samples: int = parameter(600, "ways of driving tried each period", bounds=POSITIVE, dynamic=True)
    noise_vel_x: float = parameter(
        0.3, "standard deviation of the speeds tried", "m/s", POSITIVE, dynamic=True
    )
    noise_vel_theta: float = parameter(
        0.8, "standard deviation of the turn rates tried", "rad/s", POSITIVE, dynamic=True
    )
    temperature: float = parameter(
        0.05, "how much worse than the best a way may be and still count", "m", POSITIVE, dynamic=True
    )
    safe_distance: float = parameter(
        0.15, "from the outline to obstacles, below which driving is dear", "m", at_least(0.0), dynamic=True
    )
    approach_time: float = parameter(
        0.25,
        "that it takes at least to cover what is left of that distance",
        "s",
        at_least(0.0),
        dynamic=True,
    )
    creep_vel_x: float = parameter(0.3, "allowed however near an obstacle is", "m/s", POSITIVE, dynamic=True)
    obstacle_weight: float = parameter(
        2.0,
        "per metre driven in touch with an obstacle, less farther away",
        bounds=at_least(0.0),
        dynamic=True,
    )
    turn_weight: float = parameter(0.02, "of the square of the turn rate", "s", at_least(0.0), dynamic=True)
    backward_weight: float = parameter(1.0, "per metre driven backwards", bounds=at_least(0.0), dynamic=True)
    heading_weight: float = parameter(
        0.2, "of an end that faces away from the goal", "m", at_least(0.0), dynamic=True
    )
    delay_weight: float = parameter(
        0.5, "of the way left while it is left", "1/s", at_least(0.0), dynamic=True
    )
    mover_weight: float = parameter(
        10.0,
        "of a way that ends at what moves, less the later and the less surely it does",
        "m",
        at_least(0.0),
        dynamic=True,
    )
    mover_distance: float = parameter(
        0.15, "from the outline to what moves, within which it is dear to be", "m", POSITIVE, dynamic=True
    )
    mover_range: float = parameter(
        4.0, "up to which it is looked for what moves", "m", POSITIVE, dynamic=True
    )
    watch_what_appears: bool = parameter(
        False,
        "whether what comes out from behind something is watched for a motion of its own: on open ground; in "
        "a home some furniture seems to move",
        dynamic=True,
    )
    heed_global_costmap: bool = parameter(
        False,
        "whether walls that only the global costmap knows count, too: for a sensor that only looks ahead",
        dynamic=True,
    )
    predict_movers: bool = parameter(
        True,
        "whether people and all that moves are expected where they will be instead of where they are seen",
        dynamic=True,
    )
    seed: int = parameter(0, "of the ways tried", dynamic=True)

    @property
    def lookout(self) -> Optional[Lookout]:
        return Lookout(self.mover_range, self.watch_what_appears) if self.predict_movers else None
