"""From where a frontier can be looked at."""

import math
from typing import List, Optional

import numpy as np

from explorer_lite.frontiers import Frontier
from planar import OccupancyGrid, Pose2
from planar.ray_casting import cast_rays


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
    offsets = places_xy - middle_xy
    lengths = np.hypot(offsets[:, 0], offsets[:, 1])
    allowed = lengths <= reach
    for pose in shunned:
        allowed &= np.hypot(places_xy[:, 0] - pose.x, places_xy[:, 1] - pose.y) > shunned_radius
    places_xy, offsets, lengths = places_xy[allowed], offsets[allowed], lengths[allowed]
    if len(places_xy) == 0:
        return None
    directions = np.arctan2(offsets[:, 1], offsets[:, 0])
    sights = cast_rays(grid, Pose2(*middle_xy.tolist()), directions, reach + grid.resolution)
    in_sight = sights >= lengths
    if not in_sight.any():
        return None
    best = int(np.argmin(np.where(in_sight, lengths, np.inf)))
    x, y = places_xy[best].tolist()
    beyond = -offsets[best] if lengths[best] > 0.0 else middle_xy - [robot.x, robot.y]
    return Pose2(x, y, math.atan2(beyond[1], beyond[0]))
