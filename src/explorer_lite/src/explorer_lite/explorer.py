"""The explorer: selects the next goal until no reachable frontier is left."""

import enum
import math
from dataclasses import dataclass
from typing import List, Optional, Union

import numpy as np

from explorer_lite.config import ExplorerSettings
from explorer_lite.frontiers import Frontier, known_part
from explorer_lite.progress import GoalProgressChecker
from explorer_lite.targets import ReachableSpace, Target, TargetFinder, reachable_space
from planar import FREE, OccupancyGrid, Pose2, grid_from_picture
from planar.driving import FinishTask, GoalFailed, GoalReached
from planar.elapsed_time import ElapsedTime

# Displacement of a frontier's middle above which its goal is sent again [m].
RESEND_DISTANCE = 0.5
# A map received earlier than this after an arrival may not include the scans taken there [s].
SETTLE_SECONDS = 1.0


class ExplorerState(enum.Enum):
    """State of the exploration."""

    READY = "ready"
    EXPLORING = "exploring"
    RETURNING = "returning"
    DONE = "done"
    FAILED = "failed"


@dataclass(frozen=True)
class SendGoal:
    """Order to send a goal, which replaces any earlier one.

    Attributes:
        pose: Goal pose in the map frame.
    """

    pose: Pose2


Order = Union[SendGoal, FinishTask]
Event = Union[GoalReached, GoalFailed]


class Explorer:
    """Sends the robot to the cheapest frontier until none is left, then back to its start pose.

    A frontier that persists although the robot was at its viewpoint, or that cannot be reached, is tried from
    other viewpoints, and counts as unreachable after some attempts.

    Args:
        settings: Settings of the explorer.
        return_to_start: Whether to return at the end.
        start: Pose to return to, in the map frame; by default the robot's first pose.
    """

    def __init__(
        self,
        settings: ExplorerSettings = ExplorerSettings(),
        return_to_start: bool = True,
        start: Optional[Pose2] = None,
    ):
        self._settings = settings
        self._return_to_start = return_to_start
        self._elapsed = ElapsedTime()
        self._grid: Optional[OccupancyGrid] = None
        self._grid_time = 0.0
        self._start = start
        self._next_update = 0.0
        self._target: Optional[Target] = None
        self._arrived_at: Optional[float] = None
        self._finder = TargetFinder(settings)
        self._progress = GoalProgressChecker(settings.progress_timeout)
        self._return_attempts = 0
        self.state = ExplorerState.READY

    @property
    def frontiers(self) -> List[Frontier]:
        """Frontiers that have a viewpoint."""
        return self._finder.frontiers

    @property
    def unreachable(self) -> List[Frontier]:
        """Frontiers without a viewpoint, or that failed too often."""
        return self._finder.unreachable

    @property
    def explored_area(self) -> float:
        """Area of known free space [m^2]."""
        if self._grid is None:
            return 0.0
        return float(np.count_nonzero(self._grid.cells == FREE)) * self._grid.resolution**2

    @property
    def start(self) -> Optional[Pose2]:
        """Pose to return to; None before it is known."""
        return self._start

    def advance(
        self, now: float, grid: Optional[OccupancyGrid], robot: Pose2, event: Optional[Event] = None
    ) -> Optional[Order]:
        """Compute the next order.

        Args:
            now: Time [s].
            grid: A map that was not passed before, or None.
            robot: Robot pose in the map frame.
            event: Outcome of the last goal, if it has ended since the last call.

        Returns:
            An order; None to continue with the last one.
        """
        now = self._elapsed.update(now)
        if grid is not None:
            self._grid, self._grid_time = known_part(grid), now
        if self._grid is None or self.state in (ExplorerState.DONE, ExplorerState.FAILED):
            return None
        if self.state is ExplorerState.READY:
            self._start, self._next_update = self._start or robot, now
            self._progress.restart(now)
            self.state = ExplorerState.EXPLORING
        if self.state is ExplorerState.RETURNING and event is not None:
            return self._on_return_event(now, event)
        if isinstance(event, GoalFailed):
            self._refuse_target()
            self._progress.on_goal_refused(robot)
            if self._progress.is_stranded:
                return self._finish(
                    False, f"the robot is stuck, all goals from here were refused: {event.reason}"
                )
        elif isinstance(event, GoalReached):
            self._arrived_at = now
            self._progress.restart(now)
        return self._update_target(now, robot) if self._is_update_due(now) else None

    def _is_update_due(self, now: float) -> bool:
        if self._arrived_at is not None:
            has_new_map = self._grid_time >= self._arrived_at + SETTLE_SECONDS
            return has_new_map or now >= self._arrived_at + self._settings.map_patience
        return now >= self._next_update or (self._target is None and self.state is ExplorerState.EXPLORING)

    def _update_target(self, now: float, robot: Pose2) -> Optional[Order]:
        """Evaluate the frontiers and select a goal."""
        assert self._grid is not None
        self._next_update = now + 1.0 / self._settings.planner_frequency
        space = reachable_space(robot, self._grid, self._settings)
        targets = self._finder.find(space)
        if self._arrived_at is not None:
            self._arrived_at = None
            if self._current_target_in(targets) is not None:
                self._refuse_target()
                targets = self._finder.find(space)
            self._target = None
        goal = self._start if self._target is None else self._target.viewpoint
        assert goal is not None
        if self._progress.is_stuck(now, space.distance_to(goal)):
            if self.state is ExplorerState.RETURNING:
                return self._on_return_event(now, GoalFailed("no progress"))
            if self._target is None:
                return self._finish(False, "the map shows no free space around the robot")
            self._refuse_target()
            targets = self._finder.find(space)
        if not np.isfinite(space.distances).any():
            return None
        if not targets:
            return self._return_to_start_pose(now)
        return self._choose_target(now, targets, space)

    def _choose_target(self, now: float, targets: List[Target], space: ReachableSpace) -> Optional[Order]:
        best = min(targets, key=lambda target: target.cost)
        former, current = self._target, self._current_target_in(targets)
        self.state = ExplorerState.EXPLORING
        if former is None or current is None or current.cost > best.cost + self._settings.switch_gain:
            self._progress.restart(now)
        elif _is_still_valid(former, current.frontier, space):
            return None
        else:
            best = current
            self._progress.on_goal_moved()
        self._target = best
        return SendGoal(best.viewpoint)

    def _current_target_in(self, targets: List[Target]) -> Optional[Target]:
        """The target of what remains of the frontier that the robot was sent to."""
        if self._target is None or not targets:
            return None
        middle_xy = self._target.frontier.middle_xy
        nearest = min(targets, key=lambda target: target.frontier.distance_to(middle_xy))
        return nearest if nearest.frontier.distance_to(middle_xy) <= self._settings.blacklist_radius else None

    def _refuse_target(self) -> None:
        if self._target is not None:
            self._finder.refuse(self._target)
        self._target = None

    def _return_to_start_pose(self, now: float) -> Optional[Order]:
        if self.state is ExplorerState.RETURNING:
            return None
        self._target = None
        if not self._return_to_start:
            return self._finish(True, self._summary())
        self.state = ExplorerState.RETURNING
        self._return_attempts = 0
        return self._send_start_pose(now)

    def _send_start_pose(self, now: float) -> Order:
        assert self._start is not None
        self._return_attempts += 1
        self._progress.restart(now)
        return SendGoal(self._start)

    def _on_return_event(self, now: float, event: Event) -> Order:
        if isinstance(event, GoalReached):
            return self._finish(True, self._summary())
        if self._return_attempts <= self._settings.attempts:
            return self._send_start_pose(now)
        return self._finish(
            False, f"{self._summary()}, but the robot cannot return to the start: {event.reason}"
        )

    def _finish(self, success: bool, reason: str) -> FinishTask:
        self.state = ExplorerState.DONE if success else ExplorerState.FAILED
        return FinishTask(success, reason)

    def _summary(self) -> str:
        text = f"explored {self.explored_area:.1f} m2"
        if not self.unreachable:
            return text
        count = len(self.unreachable)
        return f"{text}, {count} unreachable frontier{'s' if count > 1 else ''} left"


def _is_still_valid(former: Target, frontier: Frontier, space: ReachableSpace) -> bool:
    """Whether the present goal is still a viewpoint of what remains of its frontier."""
    has_moved = math.dist(former.frontier.middle_xy, frontier.middle_xy) > RESEND_DISTANCE
    return not has_moved and math.isfinite(space.distance_to(former.viewpoint))


def warm_up() -> None:
    """Compile, or load from the cache, every kernel that the explorer uses."""
    grid = grid_from_picture("?.....\n......\n......", resolution=0.5)
    Explorer().advance(0.0, grid, Pose2(1.0, 0.75))
