"""Whether plans lead on that were found only after recovery behaviours had forgotten what was in the way."""

import math
from dataclasses import dataclass
from typing import Optional

from move_base_lite.errors import PlanningError

# Share of the way that was left when plans failed, below which the robot has got on since.
PROGRESS_FRACTION = 0.5
# How often the length of such a plan is driven before it is known to lead nowhere.
TRAVEL_BUDGET = 2.0


@dataclass
class RecoveryProgressChecker:
    """A plan alone does not overcome that there was none: what was forgotten may be in the way still.

    ``tried_in_vain``: how many behaviours have led to no more than such plans; ``reason``: why plans failed.
    Of the way to the goal, metres, ``least_left`` is the least that was left so far, ``left_in_trouble`` that
    when plans failed last. ``ends_at``: metres travelled by which the plan should have led on.
    """

    behaviors_tried: int = 0
    reason: Optional[PlanningError] = None
    min_remaining: float = math.inf
    remaining_at_failure: float = math.inf
    travel_limit: float = math.inf

    def budget_exceeded(self, travelled: float) -> bool:
        """Whether the plan under way should have led on by now."""
        return travelled > self.travel_limit

    def on_planning_failed(self) -> None:
        """There is no plan, and recovery begins."""
        self.remaining_at_failure, self.travel_limit = self.min_remaining, math.inf

    def on_behavior_finished(self, number: int) -> None:
        """So many behaviours have been tried; what comes of it has to be seen."""
        self.behaviors_tried, self.travel_limit = number, math.inf

    def on_control_succeeded(self, travelled: float, distance_left: float) -> None:
        """The robot drives a plan of which so much is left."""
        self.min_remaining = min(self.min_remaining, distance_left)
        if not self.behaviors_tried:
            return
        if math.isinf(self.remaining_at_failure):
            self.remaining_at_failure = distance_left
        if math.isinf(self.travel_limit):
            self.travel_limit = travelled + TRAVEL_BUDGET * distance_left
        if self.min_remaining < PROGRESS_FRACTION * self.remaining_at_failure:
            self.behaviors_tried, self.travel_limit = 0, math.inf
