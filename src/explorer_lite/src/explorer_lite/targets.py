"""Frontiers as targets: from where to look at each, what it costs to go there, and what was tried in vain."""

import math
from dataclasses import dataclass
from typing import List, Optional

import numpy as np

from explorer_lite.config import ExplorerSettings
from explorer_lite.frontiers import Frontier, find_frontiers
from explorer_lite.progress import PROGRESS_DISTANCE
from explorer_lite.travel import travel_distances
from explorer_lite.viewpoints import view_from_here, viewpoint_of
from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, wrap
from planar.geometry.distance_field import distance_field

ALL_AROUND = math.radians(300.0)
"""A sensor that sees this much at once sees beside the robot, too, when it faces a frontier."""


@dataclass(frozen=True, eq=False)
class Reach:
    """How far it is for ``robot`` to the cells of ``grid``.

    ``distances``: (rows, cols), metres of way, inf where there is none. ``goals``: the same for where the
    robot may be sent, well within the known, or else beside the unknown.
    """

    grid: OccupancyGrid
    robot: Pose2
    distances: np.ndarray
    goals: List[np.ndarray]

    def distance_to(self, pose: Pose2) -> float:
        """Metres of way, inf where there is none."""
        cell = self.grid.cells_of([[pose.x, pose.y]])
        return float(self.distances[tuple(cell[0])]) if self.grid.contains(cell)[0] else math.inf


def reach_of(robot: Pose2, grid: OccupancyGrid, settings: ExplorerSettings) -> Reach:
    """Where the robot gets to in this map."""
    room = distance_field(grid.cells == OCCUPIED, grid.resolution)
    distances = travel_distances(grid, room, robot, settings.clearance)
    known_room = distance_field(grid.cells != FREE, grid.resolution)
    goals = [np.where(space > settings.goal_clearance, distances, np.inf) for space in (known_room, room)]
    return Reach(grid, robot, distances, goals)


@dataclass(frozen=True, eq=False)
class Target:
    """A frontier and from where it is to be looked at; ``cost`` in metres of way.

    ``in_passing``: the robot was there when it took notice of the frontier.
    """

    frontier: Frontier
    viewpoint: Pose2
    cost: float
    in_passing: bool


class TargetFinder:
    """Finds the targets of a map, but for those that were refused too often.

    ``frontiers`` are those of the last map still worth going to, ``unreachable`` those that are not or have
    been given up.
    """

    def __init__(self, settings: ExplorerSettings):
        self._settings = settings
        self._refused: List[Target] = []
        self.frontiers: List[Frontier] = []
        self.unreachable: List[Frontier] = []

    def refuse(self, target: Target) -> None:
        """The frontier was tried in vain from the viewpoint, or, in passing, only by a turn on the spot."""
        self._refused.append(target)

    def find(self, reach: Reach) -> List[Target]:
        """The frontiers that can be looked at from one of the goals, the earlier ones first."""
        settings = self._settings
        self.frontiers, self.unreachable = [], []
        targets = []
        for frontier in find_frontiers(reach.grid, settings.min_frontier_size, settings.max_frontier_size):
            viewpoint = self._viewpoint(frontier, reach)
            if viewpoint is None:
                self.unreachable.append(frontier)
                continue
            self.frontiers.append(frontier)
            cost = settings.potential_scale * reach.distance_to(viewpoint)
            cost += settings.orientation_scale * _turn(reach.robot, viewpoint)
            cost -= settings.gain_scale * frontier.size
            in_passing = reach.robot.distance_to(viewpoint) < PROGRESS_DISTANCE
            targets.append(Target(frontier, viewpoint, cost, in_passing))
        return targets

    def _viewpoint(self, frontier: Frontier, reach: Reach) -> Optional[Pose2]:
        settings, middle_xy = self._settings, frontier.middle_xy
        gaps = [float(np.hypot(*(refused.frontier.middle_xy - middle_xy))) for refused in self._refused]
        attempts = [
            gap <= settings.blacklist_radius and not refused.in_passing
            for refused, gap in zip(self._refused, gaps)
        ]
        if sum(attempts) >= settings.attempts:
            return None
        shunned = [refused.viewpoint for refused, gap in zip(self._refused, gaps) if gap <= settings.reach]
        limits = settings.reach, shunned, settings.blacklist_radius
        if 0.0 < settings.field_of_view < ALL_AROUND:
            viewpoint = view_from_here(frontier, reach.grid, reach.robot, *limits)
            if viewpoint is not None:
                return viewpoint
        for goal_distances in reach.goals:
            viewpoint = viewpoint_of(frontier, reach.grid, goal_distances, reach.robot, *limits)
            if viewpoint is not None:
                return viewpoint
        return None


def _turn(robot: Pose2, goal: Pose2) -> float:
    """By how much the robot has to turn to drive straight to a goal, or to face it on the spot, radians."""
    if robot.distance_to(goal) < PROGRESS_DISTANCE:
        return abs(wrap(goal.yaw - robot.yaw))
    return abs(wrap(math.atan2(goal.y - robot.y, goal.x - robot.x) - robot.yaw))
