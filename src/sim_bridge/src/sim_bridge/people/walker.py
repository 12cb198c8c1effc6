"""Description of a pedestrian."""

from dataclasses import dataclass

import numpy as np

from sim_bridge.errors import WorldError


@dataclass(frozen=True, eq=False)
class Walker:
    """A pedestrian that visits its goals in turn, again and again, starting at the first.

    Attributes:
        name: Name of the model.
        goals_xy: Goals (N, 2) in the world [m]; a pedestrian with one goal stands there.
        speed: Preferred speed [m/s].
        rest: Time spent at each goal [s].
        group: Pedestrians with the same number walk together; 0 for alone.
        radius: Radius of the body [m].
        height: Height of the body [m].

    Raises:
        WorldError: A value is not valid.
    """

    name: str
    goals_xy: np.ndarray
    speed: float = 1.0
    rest: float = 0.0
    group: int = 0
    radius: float = 0.2
    height: float = 1.6

    def __post_init__(self):
        has_goals = self.goals_xy.ndim == 2 and self.goals_xy.shape[1] == 2 and len(self.goals_xy) > 0
        if not (has_goals and np.isfinite(self.goals_xy).all()):
            raise WorldError(f"{self.name}: a person needs goals, each of x and y")
        if not (self.speed > 0.0 and self.radius > 0.0 and self.height > 0.0 and self.rest >= 0.0):
            raise WorldError(f"{self.name}: a person needs a positive speed, radius and height")

    @property
    def link(self) -> str:
        """Name of its link."""
        return f"{self.name}::link"
