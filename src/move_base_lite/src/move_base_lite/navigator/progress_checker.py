"""Goal progress check after recovery, for plans that appear only because the costmap was cleared.

Goal progress in general (move_base: ``~oscillation_distance``, ``~oscillation_timeout``) is measured by
``GoalExecution.update`` and checked by ``state_machine``.
"""

import math
from dataclasses import dataclass
from typing import Optional

from move_base_lite.errors import PlanningError

# Fraction of the remaining path below which the robot counts as having passed the obstruction.
PROGRESS_FRACTION = 0.5
# Multiple of the plan's length the robot may travel before the plan counts as leading nowhere.
TRAVEL_BUDGET = 2.0


@dataclass
class RecoveryProgressChecker:
    """Decides whether a plan found after clearing the costmap makes progress.

    Clearing removes obstacles from the costmap, not from the world, so a new plan alone does not prove that
    the way is free.

    Attributes:
        behaviors_tried: Recovery behaviours that led only to such plans.
        planning_error: Why planning failed before the first of them.
        min_remaining: Shortest remaining path so far [m].
        remaining_at_failure: Remaining path when planning last failed [m].
        travel_limit: Travelled distance by which the plan must have made progress [m].
    """

    behaviors_tried: int = 0
    planning_error: Optional[PlanningError] = None
    min_remaining: float = math.inf
    remaining_at_failure: float = math.inf
    travel_limit: float = math.inf

    def budget_exceeded(self, travelled: float) -> bool:
        """Check whether the robot has travelled so far that the current plan should have made progress.

        Args:
            travelled: Distance travelled since the goal was accepted [m].
        """
        return travelled > self.travel_limit

    def on_planning_failed(self) -> None:
        """Record that there is no plan and recovery starts."""
        self.remaining_at_failure, self.travel_limit = self.min_remaining, math.inf

    def on_behavior_finished(self, behaviors_tried: int) -> None:
        """Record that a recovery behaviour has ended; a plan found now has to make progress.

        Args:
            behaviors_tried: Number of recovery behaviours that led only to such plans.
        """
        self.behaviors_tried, self.travel_limit = behaviors_tried, math.inf

    def on_control_succeeded(self, travelled: float, remaining: float) -> None:
        """Update with the path that remains while the robot follows a plan.

        Args:
            travelled: Distance travelled since the goal was accepted [m].
            remaining: Length of the path that remains [m].
        """
        self.min_remaining = min(self.min_remaining, remaining)
        if not self.behaviors_tried:
            return
        if math.isinf(self.remaining_at_failure):
            self.remaining_at_failure = remaining
        if math.isinf(self.travel_limit):
            self.travel_limit = travelled + TRAVEL_BUDGET * remaining
        if self.min_remaining < PROGRESS_FRACTION * self.remaining_at_failure:
            self.behaviors_tried, self.travel_limit = 0, math.inf
