"""The critics of dwa_local_planner: numba kernels that score a trajectory.

A critic takes the trajectory's poses (N, 3) and the DwaScene and returns a cost, inf for an invalid
trajectory. ``scores_of`` sums the weighted costs; a new critic needs a weight and a term there.
"""

import math
from typing import NamedTuple

import numba
import numpy as np

from move_base_lite.control.dwa.arcs import arc
from move_base_lite.control.dwa.map_grid import UNREACHABLE
from move_base_lite.costmap import INSCRIBED
from move_base_lite.costmap.footprint import COLLISION, count_contacts, footprint_cost


class DwaScene(NamedTuple):
    """Grids that trajectories are scored on, and the robot's footprint.

    Attributes:
        costs: (rows, cols) of the local costmap, uint8.
        origin_x: Lower left corner of the grids in the local frame [m].
        origin_y: Lower left corner of the grids in the local frame [m].
        resolution: Cell size [m].
        outline_xy: (N, 2) footprint points in the base frame [m].
        path_map: (rows, cols) distance to the plan [cells] (base_local_planner's MapGrid).
        goal_map: (rows, cols) distance to the plan's end in the window [cells].
        goal_front_map: (rows, cols) distance to the forward point of a robot at the plan's end [cells].
        forward_distance: Distance of the forward point ahead of the robot's centre [m].
    """

    costs: np.ndarray
    origin_x: float
    origin_y: float
    resolution: float
    outline_xy: np.ndarray
    path_map: np.ndarray
    goal_map: np.ndarray
    goal_front_map: np.ndarray
    forward_distance: float


class ArcSampling(NamedTuple):
    """How the trajectory of a velocity is sampled.

    Attributes:
        start: (3,), start pose x, y, yaw in the local frame [m, rad].
        seconds: Duration [s].
        granularity: Largest distance between consecutive poses [m].
        angular_granularity: Largest rotation between consecutive poses [rad].
    """

    start: np.ndarray
    seconds: float
    granularity: float
    angular_granularity: float


class CriticWeights(NamedTuple):
    """Weights of the critics.

    Attributes:
        obstacles: Weight of the highest cost under the footprint.
        path_distance: Weight of ``path_distance`` [1/cell].
        goal_distance: Weight of ``goal_distance`` [1/cell].
        path_alignment: Weight of ``path_alignment`` [1/cell].
        goal_alignment: Weight of ``goal_alignment`` [1/cell].
        twirling: Weight of the turn rate [s/rad].
    """

    obstacles: float
    path_distance: float
    goal_distance: float
    path_alignment: float
    goal_alignment: float
    twirling: float


@numba.njit(cache=True)
def scores_of(velocities, sampling, scene, weights):
    """Score the trajectories of velocities: the weighted sum of the critics.

    Args:
        velocities: (N, 2) of v, omega [m/s, rad/s].
        sampling: ArcSampling.
        scene: DwaScene.
        weights: CriticWeights.

    Returns:
        Scores (N,), lowest for the best velocity, inf for an invalid one.
    """
    x, y, yaw = sampling.start
    start_contacts = count_contacts(
        scene.costs, scene.origin_x, scene.origin_y, scene.resolution, scene.outline_xy, x, y, yaw
    )
    scores = np.full(velocities.shape[0], np.inf)
    for i in range(velocities.shape[0]):
        v, omega = velocities[i]
        poses = arc(
            sampling.start, v, omega, sampling.seconds, sampling.granularity, sampling.angular_granularity
        )
        obstacle_cost = obstacles(poses, scene, start_contacts)
        if obstacle_cost == np.inf:
            continue
        to_path, to_goal = path_distance(poses, scene), goal_distance(poses, scene)
        if to_path >= UNREACHABLE or to_goal >= UNREACHABLE:
            continue
        scores[i] = (
            weights.obstacles * obstacle_cost
            + weights.path_distance * to_path
            + weights.goal_distance * to_goal
            + weights.path_alignment * path_alignment(poses, scene)
            + weights.goal_alignment * goal_alignment(poses, scene)
        ) + weights.twirling * twirling(omega)
    return scores


@numba.njit(cache=True)
def obstacles(poses, scene, start_contacts):
    """Highest cost under the footprint along the trajectory, inf if it collides.

    Args:
        poses: (N, 3), trajectory.
        scene: DwaScene.
        start_contacts: Footprint points in collision at the start. If there are any, the robot may move as
            long as their number never rises.
    """
    highest = 0.0
    for j in range(poses.shape[0]):
        x, y, yaw = poses[j]
        if start_contacts > 0:
            contacts = count_contacts(
                scene.costs, scene.origin_x, scene.origin_y, scene.resolution, scene.outline_xy, x, y, yaw
            )
            if contacts > start_contacts:
                return np.inf
            start_contacts = contacts
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
    """Distance of the end pose to the plan [cells]."""
    return _interpolated_distance(scene.path_map, scene, poses[-1, 0], poses[-1, 1])


@numba.njit(cache=True)
def goal_distance(poses, scene):
    """Distance of the end pose to the plan's end in the window [cells]."""
    return _interpolated_distance(scene.goal_map, scene, poses[-1, 0], poses[-1, 1])


@numba.njit(cache=True)
def path_alignment(poses, scene):
    """Distance of the end pose's forward point to the plan [cells]."""
    x, y = _forward_point(poses[-1], scene.forward_distance)
    return _interpolated_distance(scene.path_map, scene, x, y)


@numba.njit(cache=True)
def goal_alignment(poses, scene):
    """Distance of the end pose's forward point to that of a robot at the plan's end [cells]."""
    x, y = _forward_point(poses[-1], scene.forward_distance)
    return _interpolated_distance(scene.goal_front_map, scene, x, y)


@numba.njit(cache=True)
def twirling(omega):
    """Absolute turn rate [rad/s]."""
    return abs(omega)


@numba.njit(cache=True)
def _forward_point(pose, forward_distance):
    return pose[0] + forward_distance * math.cos(pose[2]), pose[1] + forward_distance * math.sin(pose[2])


@numba.njit(cache=True)
def _interpolated_distance(distances, scene, x, y):
    """Distance in cells, interpolated between cell centres so that motions below a cell change it."""
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
