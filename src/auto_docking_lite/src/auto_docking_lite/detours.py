"""Ways around obstacles to a dock, on a grid of what the scan shows."""

from typing import Optional, Sequence

import numpy as np

from auto_docking_lite.motion import CLEARANCE, TOUCH, is_free
from planar import Pose2
from planar.geometry.grid_graph import grid_graph

# Size of a cell, and distance from start and end within which ways are searched [m].
RESOLUTION, REACH = 0.06, 1.5
# Clearance beyond the robot's radius that a way must have, and that it prefers [m].
MIN_CLEARANCE, PREFERRED_CLEARANCE = 0.015, 0.12
# Factor of the length of a way without clearance, compared with one that has the preferred clearance.
DETOUR_FACTOR = 3.0
# Distance from a position within which a cell may stand for it, and to which a leg may lead at most [m].
NEAR, MAX_LEG = 0.15, 1.0


def free_legs(obstacles_xy: np.ndarray, start: Pose2, end: Pose2, radius: float) -> Optional[Sequence[Pose2]]:
    """Return the positions on a free way of straight legs to a target; None without one.

    The way is the straight one if that is free, else the shortest one on a grid; one with little clearance
    counts as longer.

    Args:
        obstacles_xy: Obstacles (N, 2), in the frame of the poses.
        start: Position of the robot; it may leave obstacles that touch it.
        end: Target.
        radius: Radius of the robot [m].
    """
    if is_free(obstacles_xy, start, end, radius):
        return (end,)
    if float(np.hypot(*(obstacles_xy - (end.x, end.y)).T).min()) < radius + MIN_CLEARANCE:
        return None
    path_xy = _shortest(obstacles_xy, start, end, radius)
    if path_xy is None:
        return None
    return (_first_leg(obstacles_xy, start, path_xy, radius), end)


def _shortest(obstacles_xy: np.ndarray, start: Pose2, end: Pose2, radius: float) -> Optional[np.ndarray]:
    """Return the positions (N, 2) on the shortest way: cells' centres and the end; None without one."""
    from scipy.sparse.csgraph import dijkstra  # imported late: few drives need it
    from scipy.spatial import cKDTree

    corners = np.array(((start.x, start.y), (end.x, end.y)))
    low, high = corners.min(axis=0) - REACH, corners.max(axis=0) + REACH
    x, y = (np.arange(low[axis], high[axis], RESOLUTION) for axis in (0, 1))
    cells_xy = np.stack(np.meshgrid(x, y), axis=-1)
    from_start = np.hypot(cells_xy[..., 0] - start.x, cells_xy[..., 1] - start.y)
    obstacles = cKDTree(obstacles_xy)
    clearance = obstacles.query(cells_xy)[0] - radius
    room = float(obstacles.query(corners[0])[0]) - radius - TOUCH / 2.0
    is_open = clearance > np.where(from_start < 2.0 * NEAR, min(MIN_CLEARANCE, room), MIN_CLEARANCE)
    first, last = (_cell_at(cells_xy, is_open, pose) for pose in (start, end))
    if first is None or last is None:
        return None
    graph = grid_graph(is_open, RESOLUTION).tocoo()
    lack = np.clip(1.0 - clearance.ravel() / PREFERRED_CLEARANCE, 0.0, 1.0)
    factor = 1.0 + (DETOUR_FACTOR - 1.0) * lack
    graph.data *= 0.5 * (factor[graph.row] + factor[graph.col])
    lengths, before = dijkstra(graph.tocsr(), directed=False, indices=first, return_predecessors=True)
    if not np.isfinite(lengths[last]):
        return None
    path = [last]
    while path[-1] != first:
        path.append(int(before[path[-1]]))
    return np.vstack((cells_xy.reshape(-1, 2)[path[::-1]], corners[1]))


def _cell_at(cells_xy: np.ndarray, is_open: np.ndarray, pose: Pose2) -> Optional[int]:
    """Return the index of the open cell nearest to a position; None if there is none near it."""
    distances = np.hypot(cells_xy[..., 0] - pose.x, cells_xy[..., 1] - pose.y)
    distances[~is_open] = np.inf
    nearest = int(distances.argmin())
    return nearest if distances.flat[nearest] < NEAR else None


def _first_leg(obstacles_xy: np.ndarray, start: Pose2, path_xy: np.ndarray, radius: float) -> Pose2:
    """Return the farthest position on a way to which the robot can drive straight."""
    legs = [Pose2(float(x), float(y)) for x, y in path_xy]
    near = [leg for leg in legs[:-1] if RESOLUTION < start.distance_to(leg) < MAX_LEG]
    near += legs[-1:] if start.distance_to(legs[-1]) < MAX_LEG else []
    for clearance in (0.0, MIN_CLEARANCE - CLEARANCE):
        for leg in reversed(near):
            if is_free(obstacles_xy, start, leg, radius + clearance):
                return leg
    return near[0]
