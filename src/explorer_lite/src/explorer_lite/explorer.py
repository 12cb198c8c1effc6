"""The explorer: which place to drive to next, until no place is left that would show anything new."""

import enum
import math
from dataclasses import dataclass
from typing import List, Optional, Union

import numpy as np

from explorer_lite.config import ExplorerSettings
from explorer_lite.frontiers import Frontier, known_part
from explorer_lite.progress import ProgressWatch
from explorer_lite.targets import Reach, Target, TargetFinder, reach_of
from planar import FREE, OccupancyGrid, Pose2
from planar.driving import FinishTask, GoalFailed, GoalReached
from planar.elapsed import ElapsedTime

RESEND_DISTANCE = 0.5
SETTLE_SECONDS = 1.0
"""A map that comes earlier than this after an arrival may not yet show what is seen from there."""


class ExplorerState(enum.Enum):
    """What the explorer is about."""

    READY = "ready"
    EXPLORING = "exploring"
    RETURNING = "returning"
    DONE = "done"
    FAILED = "failed"


@dataclass(frozen=True)
class GoTo:
    """Order: drive there. It takes the place of any earlier order."""

    pose: Pose2


Order = Union[GoTo, FinishTask]
Event = Union[GoalReached, GoalFailed]


class Explorer:
    """Sends a robot to frontiers, the cheapest first, then back to where it started.

    A frontier that stays although the robot has looked at it, or that the robot cannot get to, is tried from
    other viewpoints and given up after some attempts.
    """

    def __init__(
        self,
        settings: ExplorerSettings = ExplorerSettings(),
        return_to_start: bool = True,
        start: Optional[Pose2] = None,
    ):
        """``start``: where to return to, in the map; by default where the robot is at first."""
        self._settings = settings
        self._return_to_start = return_to_start
        self._elapsed = ElapsedTime()
        self._grid: Optional[OccupancyGrid] = None
        self._grid_time = 0.0
        self._start = start
        self._next_look = 0.0
        self._target: Optional[Target] = None
        self._arrived_at: Optional[float] = None
        self._finder = TargetFinder(settings)
        self._progress = ProgressWatch(settings.progress_timeout)
        self._return_attempts = 0
        self.state = ExplorerState.READY

    @property
    def frontiers(self) -> List[Frontier]:
        """The frontiers still worth going to."""
        return self._finder.frontiers

    @property
    def unreachable(self) -> List[Frontier]:
        """The frontiers that are not, or have been given up."""
        return self._finder.unreachable

    @property
    def explored_area(self) -> float:
        """Free space known so far, square metres."""
        if self._grid is None:
            return 0.0
        return float(np.count_nonzero(self._grid.cells == FREE)) * self._grid.resolution**2

    @property
    def start(self) -> Optional[Pose2]:
        """Where the robot returns to, None before it is known."""
        return self._start

    def advance(
        self, now: float, grid: Optional[OccupancyGrid], robot: Pose2, event: Optional[Event] = None
    ) -> Optional[Order]:
        """The next order, or None to carry on.

        ``now``: seconds; ``grid``: a map not given before, or None; ``robot``: its pose in that map;
        ``event``: what came of the last order.
        """
        now = self._elapsed.at(now)
        if grid is not None:
            self._grid, self._grid_time = known_part(grid), now
        if self._grid is None or self.state in (ExplorerState.DONE, ExplorerState.FAILED):
            return None
        if self.state is ExplorerState.READY:
            self._start, self._next_look = self._start or robot, now
            self._progress.restart(now)
            self.state = ExplorerState.EXPLORING
        if self.state is ExplorerState.RETURNING and event is not None:
            return self._end_return(now, event)
        if isinstance(event, GoalFailed):
            self._refuse_target()
            self._progress.note_refusal(robot)
            if self._progress.is_stranded:
                return self._finish(False, f"the robot does not get away from here: {event.reason}")
        elif isinstance(event, GoalReached):
            self._arrived_at = now
            self._progress.restart(now)
        return self._look(now, robot) if self._is_time_to_look(now) else None

    def _is_time_to_look(self, now: float) -> bool:
        if self._arrived_at is not None:
            has_news = self._grid_time >= self._arrived_at + SETTLE_SECONDS
            return has_news or now >= self._arrived_at + self._settings.map_patience
        return now >= self._next_look or (self._target is None and self.state is ExplorerState.EXPLORING)

    def _look(self, now: float, robot: Pose2) -> Optional[Order]:
        """Takes stock of the frontiers and decides where to go."""
        assert self._grid is not None
        self._next_look = now + 1.0 / self._settings.planner_frequency
        reach = reach_of(robot, self._grid, self._settings)
        targets = self._finder.find(reach)
        if self._arrived_at is not None:
            self._arrived_at = None
            if self._same_as_before(targets) is not None:
                self._refuse_target()
                targets = self._finder.find(reach)
            self._target = None
        goal = self._start if self._target is None else self._target.viewpoint
        assert goal is not None
        if self._progress.is_stuck(now, reach.distance_to(goal)):
            if self.state is ExplorerState.RETURNING:
                return self._end_return(now, GoalFailed("no progress"))
            if self._target is None:
                return self._finish(False, "the map shows no free space around the robot")
            self._refuse_target()
            targets = self._finder.find(reach)
        if not np.isfinite(reach.distances).any():
            return None
        if not targets:
            return self._go_back(now)
        return self._go_on(now, targets, reach)

    def _go_on(self, now: float, targets: List[Target], reach: Reach) -> Optional[Order]:
        best = min(targets, key=lambda target: target.cost)
        former, current = self._target, self._same_as_before(targets)
        self.state = ExplorerState.EXPLORING
        if former is None or current is None or current.cost > best.cost + self._settings.switch_gain:
            self._progress.restart(now)
        elif _still_serves(former, current.frontier, reach):
            return None
        else:
            best = current
            self._progress.goal_moved()
        self._target = best
        return GoTo(best.viewpoint)

    def _same_as_before(self, targets: List[Target]) -> Optional[Target]:
        """The target with what is left of the frontier that the robot was sent to."""
        if self._target is None or not targets:
            return None
        middle_xy = self._target.frontier.middle_xy
        nearest = min(targets, key=lambda target: target.frontier.distance_to(middle_xy))
        return nearest if nearest.frontier.distance_to(middle_xy) <= self._settings.blacklist_radius else None

    def _refuse_target(self) -> None:
        if self._target is not None:
            self._finder.refuse(self._target)
        self._target = None

    def _go_back(self, now: float) -> Optional[Order]:
        if self.state is ExplorerState.RETURNING:
            return None
        self._target = None
        if not self._return_to_start:
            return self._finish(True, self._praise())
        self.state = ExplorerState.RETURNING
        self._return_attempts = 0
        return self._set_out_for_start(now)

    def _set_out_for_start(self, now: float) -> Order:
        assert self._start is not None
        self._return_attempts += 1
        self._progress.restart(now)
        return GoTo(self._start)

    def _end_return(self, now: float, event: Event) -> Order:
        if isinstance(event, GoalReached):
            return self._finish(True, self._praise())
        if self._return_attempts <= self._settings.attempts:
            return self._set_out_for_start(now)
        return self._finish(False, f"{self._praise()}, but there is no way back to the start: {event.reason}")

    def _finish(self, success: bool, reason: str) -> FinishTask:
        self.state = ExplorerState.DONE if success else ExplorerState.FAILED
        return FinishTask(success, reason)

    def _praise(self) -> str:
        text = f"explored {self.explored_area:.1f} m2"
        if not self.unreachable:
            return text
        count = len(self.unreachable)
        return f"{text}, {count} unreachable frontier{'s' if count > 1 else ''} left"


def _still_serves(former: Target, frontier: Frontier, reach: Reach) -> bool:
    """Whether what is left of a frontier may be looked at from where the robot is already going."""
    has_moved = math.dist(former.frontier.middle_xy, frontier.middle_xy) > RESEND_DISTANCE
    return not has_moved and math.isfinite(reach.distance_to(former.viewpoint))
