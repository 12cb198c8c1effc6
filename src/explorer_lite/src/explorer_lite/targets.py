"""Frontiers as targets: viewpoint and cost of each, and the targets that failed."""

import math
from dataclasses import dataclass
from typing import List, Optional

import numpy as np

from explorer_lite.config import ExplorerSettings
from explorer_lite.frontiers import Frontier, find_frontiers
from explorer_lite.progress import PROGRESS_DISTANCE
from explorer_lite.travel import travel_distances
from explorer_lite.viewpoints import viewpoint_in_place, viewpoint_of
from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, wrap
from planar.geometry.distance_field import distance_field

# Field of view above which a sensor covers the surroundings of the robot at any heading.
PANORAMIC_VIEW = math.radians(300.0)


@dataclass(frozen=True, eq=False)
class ReachableSpace:
    """Path lengths from the robot to the cells of the map.

    Attributes:
        grid: Known part of the map.
        robot: Robot pose in the map frame.
        distances: Path length (rows, cols) to each cell [m], inf for unreachable cells.
        goals: Two arrays like ``distances`` of the cells that may be goals: those with goal_clearance to
            obstacles and unknown space, and those with goal_clearance to obstacles only.
    """

    grid: OccupancyGrid
    robot: Pose2
    distances: np.ndarray
    goals: List[np.ndarray]

    def distance_to(self, pose: Pose2) -> float:
        """Return the path length to a pose in the map frame [m], inf if it is unreachable."""
        cell = self.grid.cells_of([[pose.x, pose.y]])
        return float(self.distances[tuple(cell[0])]) if self.grid.contains(cell)[0] else math.inf


def reachable_space(robot: Pose2, grid: OccupancyGrid, settings: ExplorerSettings) -> ReachableSpace:
    """Compute which cells of a map the robot can reach.

    Args:
        robot: Robot pose in the map frame.
        grid: Known part of the map (see known_part).
        settings: Clearances of paths and goals.
    """
    obstacle_distance = distance_field(grid.cells == OCCUPIED, grid.resolution)
    distances = travel_distances(grid, obstacle_distance, robot, settings.clearance)
    unknown_distance = distance_field(grid.cells != FREE, grid.resolution)
    goals = [
        np.where(field > settings.goal_clearance, distances, np.inf)
        for field in (unknown_distance, obstacle_distance)
    ]
    return ReachableSpace(grid, robot, distances, goals)


@dataclass(frozen=True, eq=False)
class Target:
    """A frontier and the viewpoint to drive to.

    Attributes:
        frontier: The frontier.
        viewpoint: Goal pose in the map frame, facing the frontier.
        cost: Cost of the target, in metres of path.
        in_place: Whether the viewpoint is the robot's position: it only has to turn.
    """

    frontier: Frontier
    viewpoint: Pose2
    cost: float
    in_place: bool


class TargetFinder:
    """Finds the targets in a map, without those that failed too often.

    Args:
        settings: Sizes, costs and attempts.

    Attributes:
        frontiers: Frontiers of the last map with a viewpoint.
        unreachable: Frontiers of the last map without one.
    """

    def __init__(self, settings: ExplorerSettings):
        self._settings = settings
        self._refused: List[Target] = []
        self.frontiers: List[Frontier] = []
        self.unreachable: List[Frontier] = []

    def refuse(self, target: Target) -> None:
        """Mark a target as failed; one that only took a turn in place does not count as an attempt."""
        self._refused.append(target)

    def find(self, space: ReachableSpace) -> List[Target]:
        """Return a target for each frontier that has a viewpoint, in the order of find_frontiers."""
        settings = self._settings
        self.frontiers, self.unreachable = [], []
        targets = []
        for frontier in find_frontiers(space.grid, settings.min_frontier_size, settings.max_frontier_size):
            viewpoint = self._viewpoint(frontier, space)
            if viewpoint is None:
                self.unreachable.append(frontier)
                continue
            self.frontiers.append(frontier)
            cost = settings.potential_scale * space.distance_to(viewpoint)
            cost += settings.orientation_scale * _turn(space.robot, viewpoint)
            cost -= settings.gain_scale * frontier.size
            in_place = space.robot.distance_to(viewpoint) < PROGRESS_DISTANCE
            targets.append(Target(frontier, viewpoint, cost, in_place))
        return targets

    def _viewpoint(self, frontier: Frontier, space: ReachableSpace) -> Optional[Pose2]:
        settings, middle_xy = self._settings, frontier.middle_xy
        offsets = [float(np.hypot(*(refused.frontier.middle_xy - middle_xy))) for refused in self._refused]
        attempts = [
            offset <= settings.blacklist_radius and not refused.in_place
            for refused, offset in zip(self._refused, offsets)
        ]
        if sum(attempts) >= settings.attempts:
            return None
        excluded = [
            refused.viewpoint for refused, offset in zip(self._refused, offsets) if offset <= settings.reach
        ]
        limits = settings.reach, excluded, settings.blacklist_radius
        if 0.0 < settings.field_of_view < PANORAMIC_VIEW:
            viewpoint = viewpoint_in_place(frontier, space.grid, space.robot, *limits)
            if viewpoint is not None:
                return viewpoint
        for goal_distances in space.goals:
            viewpoint = viewpoint_of(frontier, space.grid, goal_distances, space.robot, *limits)
            if viewpoint is not None:
                return viewpoint
        return None


def _turn(robot: Pose2, goal: Pose2) -> float:
    """Angle to turn before driving straight to a goal, or to its heading if the robot is there [rad]."""
    if robot.distance_to(goal) < PROGRESS_DISTANCE:
        return abs(wrap(goal.yaw - robot.yaw))
    return abs(wrap(math.atan2(goal.y - robot.y, goal.x - robot.x) - robot.yaw))
