"""The critics of dwa_local_planner: what each holds against a trajectory. Kernels.

A critic is given the trajectory's poses (N, 3) and the Scene, and returns a cost, inf if the trajectory must
not be driven. They are weighed and summed by :func:`scores_of`; to add one is to add a weight and a term.
"""

import math
from typing import NamedTuple

import numba
import numpy as np

from move_base_lite.control.dwa.arcs import arc
from move_base_lite.control.dwa.map_grid import UNREACHABLE
from move_base_lite.costmap import INSCRIBED
from move_base_lite.costmap.footprint import COLLISION, count_contacts, footprint_cost


class Scene(NamedTuple):
    """What trajectories are judged by: fields (rows, cols), where they lie, and the robot.

    ``costs``: the costmap's. ``from_path``, ``from_goal``, ``from_nose_goal``: cells to the plan, to its end,
    and to where the robot's nose is when it stands there. ``nose``: metres ahead of the robot.
    """

    costs: np.ndarray
    origin_x: float
    origin_y: float
    resolution: float
    outline_xy: np.ndarray
    from_path: np.ndarray
    from_goal: np.ndarray
    from_nose_goal: np.ndarray
    nose: float


class Ways(NamedTuple):
    """How velocities are followed: from a pose (3,), for so long, poses so many metres and radians apart."""

    start: np.ndarray
    seconds: float
    granularity: float
    angular_granularity: float


class Weights(NamedTuple):
    """Of the critics; cells count in metres."""

    obstacles: float
    path_distance: float
    goal_distance: float
    path_alignment: float
    goal_alignment: float
    twirling: float


@numba.njit(cache=True)
def scores_of(velocities, ways, scene, weights):
    """Cost (N,) of each velocity (N, 2), inf if it must not be driven."""
    x, y, yaw = ways.start
    touching = count_contacts(
        scene.costs, scene.origin_x, scene.origin_y, scene.resolution, scene.outline_xy, x, y, yaw
    )
    scores = np.full(velocities.shape[0], np.inf)
    for i in range(velocities.shape[0]):
        v, omega = velocities[i]
        poses = arc(ways.start, v, omega, ways.seconds, ways.granularity, ways.angular_granularity)
        in_the_way = obstacles(poses, scene, touching)
        if in_the_way == np.inf:
            continue
        to_path, to_goal = path_distance(poses, scene), goal_distance(poses, scene)
        if to_path >= UNREACHABLE or to_goal >= UNREACHABLE:
            continue
        scores[i] = (
            weights.obstacles * in_the_way
            + weights.path_distance * to_path
            + weights.goal_distance * to_goal
            + weights.path_alignment * path_alignment(poses, scene)
            + weights.goal_alignment * goal_alignment(poses, scene)
        ) + weights.twirling * twirling(omega)
    return scores


@numba.njit(cache=True)
def obstacles(poses, scene, touching):
    """Highest cost below the footprint along the trajectory, inf if it collides.

    A robot that is ``touching`` something already, at so many points of its outline, may move as long as it
    never touches at more.
    """
    highest = 0.0
    for j in range(poses.shape[0]):
        x, y, yaw = poses[j]
        if touching > 0:
            now = count_contacts(
                scene.costs, scene.origin_x, scene.origin_y, scene.resolution, scene.outline_xy, x, y, yaw
            )
            if now > touching:
                return np.inf
            touching = now
            highest = float(INSCRIBED)
        else:
            cost = footprint_cost(
                scene.costs, scene.origin_x, scene.origin_y, scene.resolution, scene.outline_xy, x, y, yaw
            )
            if cost == COLLISION:
                return np.inf
            highest = max(highest, float(cost))
    return highest


@numba.njit(cache=True)
def path_distance(poses, scene):
    """How far from the plan it ends."""
    return _at(scene.from_path, scene, poses[-1, 0], poses[-1, 1])


@numba.njit(cache=True)
def goal_distance(poses, scene):
    """How far from the end of the plan in sight it ends."""
    return _at(scene.from_goal, scene, poses[-1, 0], poses[-1, 1])


@numba.njit(cache=True)
def path_alignment(poses, scene):
    """How far from the plan the robot's nose ends."""
    x, y = _nose_at(poses[-1], scene.nose)
    return _at(scene.from_path, scene, x, y)


@numba.njit(cache=True)
def goal_alignment(poses, scene):
    """How far from where it is to be at the end the robot's nose ends."""
    x, y = _nose_at(poses[-1], scene.nose)
    return _at(scene.from_nose_goal, scene, x, y)


@numba.njit(cache=True)
def twirling(omega):
    """How fast it turns."""
    return abs(omega)


@numba.njit(cache=True)
def _nose_at(pose, nose):
    return pose[0] + nose * math.cos(pose[2]), pose[1] + nose * math.sin(pose[2])


@numba.njit(cache=True)
def _at(distances, scene, x, y):
    """Distance in cells, interpolated between cell centres so that small motions count too."""
    rows, cols = distances.shape
    row, col = int((y - scene.origin_y) / scene.resolution), int((x - scene.origin_x) / scene.resolution)
    if row < 0 or row >= rows or col < 0 or col >= cols:
        return UNREACHABLE
    nearest = distances[row, col]
    u = (y - scene.origin_y) / scene.resolution - 0.5
    w = (x - scene.origin_x) / scene.resolution - 0.5
    row, col = int(math.floor(u)), int(math.floor(w))
    if row < 0 or row >= rows - 1 or col < 0 or col >= cols - 1:
        return nearest
    u, w = u - row, w - col
    value = (1.0 - u) * ((1.0 - w) * distances[row, col] + w * distances[row, col + 1]) + u * (
        (1.0 - w) * distances[row + 1, col] + w * distances[row + 1, col + 1]
    )
    return value if value < UNREACHABLE / rows / cols else nearest
