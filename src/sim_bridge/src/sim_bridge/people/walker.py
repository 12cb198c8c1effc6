"""A person, as data."""

from dataclasses import dataclass

import numpy as np

from sim_bridge.errors import WorldError


@dataclass(frozen=True, eq=False)
class Walker:
    """The person ``name`` goes from place to place of ``goals_xy`` (N, 2), for ever, begun at the first.

    ``speed``: m/s when nothing is in the way; ``rest``: seconds spent at each goal; ``group``: of those who
    walk together, 0: alone. Who has one goal stands there. Lengths in metres.
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
        return f"{self.name}::link"
