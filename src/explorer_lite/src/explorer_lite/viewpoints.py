"""Viewpoints: poses from which a frontier is observed."""

import math
from typing import List, Optional

import numpy as np

from explorer_lite.frontiers import Frontier
from planar import OccupancyGrid, Pose2
from planar.geometry.ray_casting import cast_rays


def viewpoint_of(
    frontier: Frontier,
    grid: OccupancyGrid,
    distances: np.ndarray,
    robot: Pose2,
    reach: float,
    excluded: List[Pose2],
    excluded_radius: float,
) -> Optional[Pose2]:
    """Find the reachable position nearest to a frontier's middle.

    Args:
        frontier: The frontier.
        grid: Known part of the map.
        distances: Path lengths (rows, cols) [m], finite for cells that may be goals; see travel_distances.
        robot: Robot pose in the map frame.
        reach: Maximum distance to the frontier's middle [m].
        excluded: Poses that failed before.
        excluded_radius: Distance to keep from those [m].

    Returns:
        A pose with a free line of sight to the frontier's middle, facing beyond it; None if there is none.
    """
    middle_xy = frontier.middle_xy
    ((row, col),) = grid.cells_of([middle_xy])
    margin = math.ceil(reach / grid.resolution)
    first_row, first_col = max(row - margin, 0), max(col - margin, 0)
    window = distances[first_row : row + margin + 1, first_col : col + margin + 1]
    positions_xy = grid.points_of(np.argwhere(np.isfinite(window)) + [first_row, first_col])
    viewing_distances = _viewing_distances(grid, middle_xy, positions_xy, reach, excluded, excluded_radius)
    if not np.isfinite(viewing_distances).any():
        return None
    best = int(np.argmin(viewing_distances))
    x, y = positions_xy[best].tolist()
    beyond = middle_xy - (positions_xy[best] if viewing_distances[best] > 0.0 else [robot.x, robot.y])
    return Pose2(x, y, math.atan2(beyond[1], beyond[0]))


def viewpoint_in_place(
    frontier: Frontier,
    grid: OccupancyGrid,
    robot: Pose2,
    reach: float,
    excluded: List[Pose2],
    excluded_radius: float,
) -> Optional[Pose2]:
    """Return the robot's position, facing a frontier, if that is a valid viewpoint.

    Args:
        frontier: The frontier.
        grid: Known part of the map.
        robot: Robot pose in the map frame.
        reach: Maximum distance to the frontier's middle [m].
        excluded: Poses that failed before.
        excluded_radius: Distance to keep from those [m].

    Returns:
        A pose facing the frontier's middle; None if the position is not valid.
    """
    here_xy, middle_xy = np.array([[robot.x, robot.y]]), frontier.middle_xy
    if not np.isfinite(_viewing_distances(grid, middle_xy, here_xy, reach, excluded, excluded_radius))[0]:
        return None
    return Pose2(robot.x, robot.y, math.atan2(middle_xy[1] - robot.y, middle_xy[0] - robot.x))


def _viewing_distances(grid, middle_xy, positions_xy, reach, excluded, excluded_radius) -> np.ndarray:
    """Distances (N,) from positions (N, 2) to a point; inf if out of reach, occluded or excluded [m]."""
    offsets = positions_xy - middle_xy
    viewing_distances = np.hypot(offsets[:, 0], offsets[:, 1])
    viewing_distances[viewing_distances > reach] = np.inf
    for pose in excluded:
        near = np.hypot(positions_xy[:, 0] - pose.x, positions_xy[:, 1] - pose.y) <= excluded_radius
        viewing_distances[near] = np.inf
    possible = np.flatnonzero(np.isfinite(viewing_distances))
    if len(possible):
        directions = np.arctan2(offsets[possible, 1], offsets[possible, 0])
        free_ranges = cast_rays(grid, Pose2(*middle_xy.tolist()), directions, reach + grid.resolution)
        viewing_distances[possible[free_ranges < viewing_distances[possible]]] = np.inf
    return viewing_distances
