"""Whether plans lead on that were found only after recovery behaviours had forgotten what was in the way."""

import math
from dataclasses import dataclass
from typing import Optional

from move_base_lite.errors import PlanningError

# Share of the way that was left when plans failed, below which the robot has got on since.
GAIN = 0.5
# How often the length of such a plan is driven before it is known to lead nowhere.
ENOUGH = 2.0


@dataclass
class Hope:
    """A plan alone does not overcome that there was none: what was forgotten may be in the way still.

    ``tried_in_vain``: how many behaviours have led to no more than such plans; ``reason``: why plans failed.
    Of the way to the goal, metres, ``least_left`` is the least that was left so far, ``left_in_trouble`` that
    when plans failed last. ``ends_at``: metres travelled by which the plan should have led on.
    """

    tried_in_vain: int = 0
    reason: Optional[PlanningError] = None
    least_left: float = math.inf
    left_in_trouble: float = math.inf
    ends_at: float = math.inf

    def is_over(self, travelled: float) -> bool:
        """Whether the plan under way should have led on by now."""
        return travelled > self.ends_at

    def lose(self) -> None:
        """There is no plan, and recovery begins."""
        self.left_in_trouble, self.ends_at = self.least_left, math.inf

    def try_behavior(self, number: int) -> None:
        """So many behaviours have been tried; what comes of it has to be seen."""
        self.tried_in_vain, self.ends_at = number, math.inf

    def drive(self, travelled: float, distance_left: float) -> None:
        """The robot drives a plan of which so much is left."""
        self.least_left = min(self.least_left, distance_left)
        if not self.tried_in_vain:
            return
        if math.isinf(self.left_in_trouble):
            self.left_in_trouble = distance_left
        if math.isinf(self.ends_at):
            self.ends_at = travelled + ENOUGH * distance_left
        if self.least_left < GAIN * self.left_in_trouble:
            self.tried_in_vain, self.ends_at = 0, math.inf
