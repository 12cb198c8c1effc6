"""From where a frontier can be looked at."""

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
    shunned: List[Pose2],
    shunned_radius: float,
) -> Optional[Pose2]:
    """The nearest place to a frontier's middle that can be driven to, facing what is beyond; None if none.

    ``distances``: (rows, cols), finite where one can drive to (see travel_distances). The place lies within
    ``reach`` metres, has the middle in sight, and is not within ``shunned_radius`` of a shunned one.
    """
    middle_xy = frontier.middle_xy
    ((row, col),) = grid.cells_of([middle_xy])
    margin = math.ceil(reach / grid.resolution)
    first_row, first_col = max(row - margin, 0), max(col - margin, 0)
    window = distances[first_row : row + margin + 1, first_col : col + margin + 1]
    places_xy = grid.points_of(np.argwhere(np.isfinite(window)) + [first_row, first_col])
    lengths = _lengths_of_sight(grid, middle_xy, places_xy, reach, shunned, shunned_radius)
    if not np.isfinite(lengths).any():
        return None
    best = int(np.argmin(lengths))
    x, y = places_xy[best].tolist()
    beyond = middle_xy - (places_xy[best] if lengths[best] > 0.0 else [robot.x, robot.y])
    return Pose2(x, y, math.atan2(beyond[1], beyond[0]))


def view_from_here(
    frontier: Frontier,
    grid: OccupancyGrid,
    robot: Pose2,
    reach: float,
    shunned: List[Pose2],
    shunned_radius: float,
) -> Optional[Pose2]:
    """The robot's own place, facing a frontier's middle, if that would do as a viewpoint; else None."""
    here_xy, middle_xy = np.array([[robot.x, robot.y]]), frontier.middle_xy
    if not np.isfinite(_lengths_of_sight(grid, middle_xy, here_xy, reach, shunned, shunned_radius))[0]:
        return None
    return Pose2(robot.x, robot.y, math.atan2(middle_xy[1] - robot.y, middle_xy[0] - robot.x))


def _lengths_of_sight(grid, middle_xy, places_xy, reach, shunned, shunned_radius) -> np.ndarray:
    """Metres (N,) from places (N, 2) to a point; inf for those out of reach or sight, or shunned."""
    offsets = places_xy - middle_xy
    lengths = np.hypot(offsets[:, 0], offsets[:, 1])
    lengths[lengths > reach] = np.inf
    for pose in shunned:
        near = np.hypot(places_xy[:, 0] - pose.x, places_xy[:, 1] - pose.y) <= shunned_radius
        lengths[near] = np.inf
    possible = np.flatnonzero(np.isfinite(lengths))
    if len(possible):
        directions = np.arctan2(offsets[possible, 1], offsets[possible, 0])
        sights = cast_rays(grid, Pose2(*middle_xy.tolist()), directions, reach + grid.resolution)
        lengths[possible[sights < lengths[possible]]] = np.inf
    return lengths
