"""The explorer: which place to drive to next, until no place is left that would show anything new."""

import enum
import math
from dataclasses import dataclass
from typing import List, Optional, Union

import numpy as np

from explorer_lite.config import ExplorerSettings
from explorer_lite.frontiers import Frontier, find_frontiers, known_part
from explorer_lite.travel import travel_distances
from explorer_lite.viewpoints import view_from_here, viewpoint_of
from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, wrap
from planar.driving import Finish, GoalReached, GoalRefused
from planar.geometry.distance_field import distance_field

PROGRESS_DISTANCE = 0.1
ALL_AROUND = math.radians(300.0)
"""A sensor that sees this much at once sees beside the robot, too, when it faces a frontier."""
RESEND_DISTANCE = 0.5
STRANDED_REFUSALS = 8
"""So many goals refused at the same place say more about the robot than about the goals."""
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


Order = Union[GoTo, Finish]
Event = Union[GoalReached, GoalRefused]


@dataclass(frozen=True, eq=False)
class Target:
    """A frontier and from where it is to be looked at; ``cost`` in metres of way.

    ``in_passing``: the robot was there when it took notice of the frontier.
    """

    frontier: Frontier
    viewpoint: Pose2
    cost: float
    in_passing: bool


@dataclass(frozen=True, eq=False)
class Refusal:
    """A frontier that was tried in vain from a viewpoint, or only ``in_passing``, by a turn on the spot."""

    middle_xy: np.ndarray
    viewpoint: Pose2
    in_passing: bool


class Explorer:
    """Sends a robot to frontiers, the cheapest first, then back to where it started.

    A frontier that stays although the robot has looked at it, or that the robot cannot get to, is tried from
    other viewpoints and given up after some attempts. ``frontiers`` are those still worth going to,
    ``unreachable`` those that are not or have been given up.
    """

    def __init__(self, settings: ExplorerSettings = ExplorerSettings(), return_to_start: bool = True):
        self._settings = settings
        self._return_to_start = return_to_start
        self._grid: Optional[OccupancyGrid] = None
        self._grid_time = 0.0
        self._start = Pose2()
        self._next_look = 0.0
        self._target: Optional[Target] = None
        self._arrived_at: Optional[float] = None
        self._nearest = math.inf
        self._progress_at = 0.0
        self._refusals: List[Refusal] = []
        self._return_attempts = 0
        self._refused_at = Pose2()
        self._refused_here = 0
        self.state = ExplorerState.READY
        self.frontiers: List[Frontier] = []
        self.unreachable: List[Frontier] = []

    @property
    def explored_area(self) -> float:
        """Free space known so far, square metres."""
        if self._grid is None:
            return 0.0
        return float(np.count_nonzero(self._grid.cells == FREE)) * self._grid.resolution**2

    def advance(
        self, now: float, grid: Optional[OccupancyGrid], robot: Pose2, event: Optional[Event] = None
    ) -> Optional[Order]:
        """The next order, or None to carry on.

        ``now``: seconds; ``grid``: a map not given before, or None; ``robot``: its pose in that map;
        ``event``: what came of the last order.
        """
        if grid is not None:
            self._grid, self._grid_time = known_part(grid), now
        if self._grid is None or self.state in (ExplorerState.DONE, ExplorerState.FAILED):
            return None
        if self.state is ExplorerState.READY:
            self._start, self._next_look, self._progress_at = robot, now, now
            self.state = ExplorerState.EXPLORING
        if self.state is ExplorerState.RETURNING and event is not None:
            return self._end_return(now, event)
        if isinstance(event, GoalRefused):
            self._refuse_target()
            if self._is_stranded(robot):
                return self._finish(False, f"the robot does not get away from here: {event.reason}")
        elif isinstance(event, GoalReached):
            self._arrived_at = now
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
        room = distance_field(self._grid.cells == OCCUPIED, self._grid.resolution)
        distances = travel_distances(self._grid, room, robot, self._settings.clearance)
        goals = self._goals(self._grid, room, distances)
        targets = self._targets(self._grid, goals, distances, robot)
        if self._arrived_at is not None:
            self._arrived_at = None
            if self._same_as_before(targets) is not None:
                self._refuse_target()
                targets = self._targets(self._grid, goals, distances, robot)
            self._target = None
        if self._is_stuck(now, distances):
            if self.state is ExplorerState.RETURNING:
                return self._end_return(now, GoalRefused("no progress"))
            if self._target is None:
                return self._finish(False, "the map shows no free space around the robot")
            self._refuse_target()
            targets = self._targets(self._grid, goals, distances, robot)
        if not np.isfinite(distances).any():
            return None
        if not targets:
            return self._go_back(now)
        return self._go_on(now, targets, distances)

    def _goals(self, grid: OccupancyGrid, room: np.ndarray, distances: np.ndarray) -> List[np.ndarray]:
        """Metres of way to where the robot may be sent: well within the known, or else beside the unknown."""
        known_room = distance_field(grid.cells != FREE, grid.resolution)
        clearance = self._settings.goal_clearance
        return [np.where(space > clearance, distances, np.inf) for space in (known_room, room)]

    def _targets(
        self, grid: OccupancyGrid, goals: List[np.ndarray], distances: np.ndarray, robot: Pose2
    ) -> List[Target]:
        """The frontiers that can be looked at from one of the goals, the earlier ones first."""
        settings = self._settings
        self.frontiers, self.unreachable = [], []
        targets = []
        for frontier in find_frontiers(grid, settings.min_frontier_size, settings.max_frontier_size):
            viewpoint = self._viewpoint(frontier, grid, goals, robot)
            if viewpoint is None:
                self.unreachable.append(frontier)
                continue
            self.frontiers.append(frontier)
            cost = settings.potential_scale * _at(distances, grid, viewpoint)
            cost += settings.orientation_scale * _turn(robot, viewpoint)
            cost -= settings.gain_scale * frontier.size
            in_passing = robot.distance_to(viewpoint) < PROGRESS_DISTANCE
            targets.append(Target(frontier, viewpoint, cost, in_passing))
        return targets

    def _viewpoint(
        self, frontier: Frontier, grid: OccupancyGrid, goals: List[np.ndarray], robot: Pose2
    ) -> Optional[Pose2]:
        settings, middle_xy = self._settings, frontier.middle_xy
        gaps = [float(np.hypot(*(refusal.middle_xy - middle_xy))) for refusal in self._refusals]
        attempts = [
            gap <= settings.blacklist_radius and not refusal.in_passing
            for refusal, gap in zip(self._refusals, gaps)
        ]
        if sum(attempts) >= settings.attempts:
            return None
        shunned = [refusal.viewpoint for refusal, gap in zip(self._refusals, gaps) if gap <= settings.reach]
        limits = settings.reach, shunned, settings.blacklist_radius
        if 0.0 < settings.field_of_view < ALL_AROUND:
            viewpoint = view_from_here(frontier, grid, robot, *limits)
            if viewpoint is not None:
                return viewpoint
        for goal_distances in goals:
            viewpoint = viewpoint_of(frontier, grid, goal_distances, robot, *limits)
            if viewpoint is not None:
                return viewpoint
        return None

    def _go_on(self, now: float, targets: List[Target], distances: np.ndarray) -> Optional[Order]:
        best = min(targets, key=lambda target: target.cost)
        former, current = self._target, self._same_as_before(targets)
        self.state = ExplorerState.EXPLORING
        if former is None or current is None or current.cost > best.cost + self._settings.switch_gain:
            self._nearest, self._progress_at = math.inf, now
        elif self._still_serves(former, current.frontier, distances):
            return None
        else:
            best = current
        self._target = best
        return GoTo(best.viewpoint)

    def _still_serves(self, former: Target, frontier: Frontier, distances: np.ndarray) -> bool:
        """Whether what is left of a frontier may be looked at from where the robot is already going."""
        assert self._grid is not None
        has_moved = math.dist(former.frontier.middle_xy, frontier.middle_xy) > RESEND_DISTANCE
        return not has_moved and math.isfinite(_at(distances, self._grid, former.viewpoint))

    def _same_as_before(self, targets: List[Target]) -> Optional[Target]:
        """The target with what is left of the frontier that the robot was sent to."""
        if self._target is None or not targets:
            return None
        middle_xy = self._target.frontier.middle_xy
        nearest = min(targets, key=lambda target: target.frontier.distance_to(middle_xy))
        return nearest if nearest.frontier.distance_to(middle_xy) <= self._settings.blacklist_radius else None

    def _refuse_target(self) -> None:
        if self._target is not None:
            target = self._target
            self._refusals.append(Refusal(target.frontier.middle_xy, target.viewpoint, target.in_passing))
        self._target = None

    def _is_stranded(self, robot: Pose2) -> bool:
        if self._refused_at.distance_to(robot) > PROGRESS_DISTANCE:
            self._refused_at, self._refused_here = robot, 0
        self._refused_here += 1
        return self._refused_here >= STRANDED_REFUSALS

    def _is_stuck(self, now: float, distances: np.ndarray) -> bool:
        """Whether the robot has come no nearer to where it was sent for too long."""
        assert self._grid is not None
        goal = self._target.viewpoint if self._target is not None else self._start
        distance = _at(distances, self._grid, goal)
        if distance < self._nearest - PROGRESS_DISTANCE:
            self._nearest, self._progress_at = distance, now
        return now - self._progress_at > self._settings.progress_timeout

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
        self._return_attempts += 1
        self._nearest, self._progress_at = math.inf, now
        return GoTo(self._start)

    def _end_return(self, now: float, event: Event) -> Order:
        if isinstance(event, GoalReached):
            return self._finish(True, self._praise())
        if self._return_attempts <= self._settings.attempts:
            return self._set_out_for_start(now)
        return self._finish(False, f"{self._praise()}, but there is no way back to the start: {event.reason}")

    def _finish(self, success: bool, reason: str) -> Finish:
        self.state = ExplorerState.DONE if success else ExplorerState.FAILED
        return Finish(success, reason)

    def _praise(self) -> str:
        text = f"explored {self.explored_area:.1f} m2"
        if not self.unreachable:
            return text
        count = len(self.unreachable)
        return f"{text}, {count} unreachable frontier{'s' if count > 1 else ''} left"


def _at(distances: np.ndarray, grid: OccupancyGrid, pose: Pose2) -> float:
    cell = grid.cells_of([[pose.x, pose.y]])
    return float(distances[tuple(cell[0])]) if grid.contains(cell)[0] else math.inf


def _turn(robot: Pose2, goal: Pose2) -> float:
    """By how much the robot has to turn to drive straight to a goal, or to face it on the spot, radians."""
    if robot.distance_to(goal) < PROGRESS_DISTANCE:
        return abs(wrap(goal.yaw - robot.yaw))
    return abs(wrap(math.atan2(goal.y - robot.y, goal.x - robot.x) - robot.yaw))
