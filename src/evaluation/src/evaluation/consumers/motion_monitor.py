"""Where the robot truly is, how far it has driven, and how fast simulated time passes."""

import time
from typing import Any, Callable, Dict, Optional

import numpy as np

from evaluation.event_stream import EventStream
from evaluation.events import GoalEnded, PlanUpdated, TruthUpdated
from planar import Pose2


class MotionMonitor:
    """Follows the true pose. Simulated time is that of its stamps.

    Args:
        clock: Returns the wall-clock time [s].

    Attributes:
        truth: Latest true pose.
        simulated_time: Its stamp [s].
        distance_driven: True distance driven [m].
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic):
        self.truth: Optional[Pose2] = None
        self.simulated_time = 0.0
        self.distance_driven = 0.0
        self._clock = clock
        self._start_time, self._start_wall = 0.0, 0.0
        # True distance driven at the end of the latest plan [m]; None without a goal.
        self._plan_end: Optional[float] = None

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(TruthUpdated, self._on_truth)
        events.subscribe(PlanUpdated, self._on_plan)
        events.subscribe(GoalEnded, self._on_goal_end)

    @property
    def simulated_seconds(self) -> float:
        """Simulated time since the first ground truth [s]."""
        return self.simulated_time - self._start_time

    @property
    def real_time_factor(self) -> float:
        """Simulated seconds per wall-clock second since the first ground truth."""
        if self.truth is None:
            return 0.0
        return self.simulated_seconds / max(self._clock() - self._start_wall, 1e-3)

    @property
    def remaining_distance(self) -> Optional[float]:
        """Length of the latest plan less the distance driven since [m]; None without a goal."""
        return None if self._plan_end is None else max(0.0, self._plan_end - self.distance_driven)

    @property
    def status(self) -> str:
        """Distance and time in one line for people."""
        remaining = self.remaining_distance
        to_go = "" if remaining is None else f"{remaining:.1f} m to go, "
        return f"{to_go}simulated {self.simulated_seconds:.1f} s, {self.real_time_factor:.1f} x real time"

    def result_fields(self) -> Dict[str, Any]:
        """Return fields of result.json."""
        return {
            "simulated_seconds": round(self.simulated_seconds, 3),
            "real_time_factor": round(self.real_time_factor, 3),
            "distance_driven": round(self.distance_driven, 3),
        }

    def _on_truth(self, event: TruthUpdated) -> None:
        if self.truth is None:
            self._start_time, self._start_wall = event.stamp, self._clock()
        else:
            self.distance_driven += self.truth.distance_to(event.pose)
        self.truth, self.simulated_time = event.pose, event.stamp

    def _on_plan(self, event: PlanUpdated) -> None:
        steps = np.diff(event.points_xy, axis=0)
        self._plan_end = self.distance_driven + float(np.hypot(steps[:, 0], steps[:, 1]).sum())

    def _on_goal_end(self, _event: GoalEnded) -> None:
        """A goal has ended: no distance remains."""
        self._plan_end = None
