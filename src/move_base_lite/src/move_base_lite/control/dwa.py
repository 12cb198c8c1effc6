"""The dynamic window approach (Fox, Burgard and Thrun, 1997) with the critics of dwa_local_planner."""

import math
from typing import Optional

import numba
import numpy as np

from move_base_lite.control.arcs import arc
from move_base_lite.control.exploration import Exploration
from move_base_lite.control.map_grid import UNREACHABLE, distances_to
from move_base_lite.control.settings import DwaSettings
from move_base_lite.control.trajectory import Trajectory
from move_base_lite.costmap import INSCRIBED, LayeredCostmap
from move_base_lite.costmap.footprint import COLLISION, count_contacts, footprint_cost
from planar import Pose2, Twist2

REJECTED = -1.0
SHORTEST_HORIZON = 0.5


class DynamicWindow:
    """Chooses among the velocities within reach, each kept for a while.

    ``exploration``: what it chose from last.
    """

    def __init__(self, settings: DwaSettings, period: float):
        self._settings = settings
        self._period = period
        self.exploration: Optional[Exploration] = None

    def follow(
        self,
        costmap: LayeredCostmap,
        base_pose: Pose2,
        twist: Twist2,
        plan_xy: np.ndarray,
        highest: Twist2,
        distance_left: float,
        movers: np.ndarray,
    ) -> Trajectory:
        """The cheapest velocity, looking no further ahead than the end, or the robot would creep towards it.

        As in the official one, whatever moves is where it is now.

        Raises ControlError if each of them hits something or leads nowhere.
        """
        horizon = min(max(distance_left / highest.v, SHORTEST_HORIZON), self._settings.sim_time)
        self.exploration = explore(
            self._settings, costmap, base_pose, twist, plan_xy, highest, horizon, self._period
        )
        return self.exploration.best()


def explore(
    settings: DwaSettings,
    costmap: LayeredCostmap,
    base_pose: Pose2,
    twist: Twist2,
    plan_xy: np.ndarray,
    highest: Twist2,
    sim_time: float,
    period: float,
) -> Exploration:
    """Scores the velocities reachable within ``period`` seconds.

    ``plan_xy``: (N, 2), the part of the plan ahead within the costmap. ``highest``: speeds.
    ``sim_time``: seconds that each velocity is followed ahead.
    """
    window = costmap.window
    goal_x, goal_y = plan_xy[-1]
    to_goal = math.atan2(goal_y - base_pose.y, goal_x - base_pose.x)
    nose = settings.forward_point_distance
    nose_goal_xy = plan_xy[-1] + nose * np.array([math.cos(to_goal), math.sin(to_goal)])
    from_path = distances_to(costmap.costs, window, plan_xy)
    from_goal = distances_to(costmap.costs, window, plan_xy[-1:])
    from_nose_goal = distances_to(costmap.costs, window, nose_goal_xy[None, :])
    path_scale = window.resolution * settings.path_distance_bias
    goal_scale = window.resolution * settings.goal_distance_bias
    far_from_goal = math.hypot(goal_x - base_pose.x, goal_y - base_pose.y) > nose * math.sqrt(
        settings.cheat_factor
    )
    samples = velocity_samples(settings, twist, highest, period)
    scores = _score(
        costmap.costs,
        window.origin_x,
        window.origin_y,
        window.resolution,
        costmap.outline_xy,
        base_pose.as_array(),
        samples,
        sim_time,
        settings.sim_granularity,
        settings.angular_sim_granularity,
        from_path,
        from_goal,
        from_nose_goal,
        nose,
        (path_scale, goal_scale, path_scale if far_from_goal else 0.0, settings.occdist_scale),
    )
    scores = np.where(scores < 0.0, np.inf, scores + settings.twirling_scale * np.abs(samples[:, 1]))
    return Exploration(
        settings, base_pose, sim_time, samples, scores, window, costmap.costs, from_path, from_goal
    )


def velocity_samples(settings: DwaSettings, twist: Twist2, highest: Twist2, period: float) -> np.ndarray:
    """Velocities (N, 2) as (v, omega) that the robot can have after ``period`` and that move it on.

    Turning on the spot is left to the controller, which knows which way. However small the acceleration,
    a robot at rest may start at ``min_vel_trans``.
    """
    horizon = period if settings.use_dwa else settings.sim_time
    change = max(settings.acc_lim_x * horizon, settings.min_vel_trans - twist.v)
    v = _spaced(twist.v, change, settings.min_vel_x, highest.v, settings.vx_samples)
    limit = highest.omega
    omega = _spaced(twist.omega, settings.acc_lim_theta * horizon, -limit, limit, settings.vth_samples)
    samples = np.stack(np.meshgrid(v, omega, indexing="ij"), axis=-1).reshape(-1, 2)
    return samples[np.abs(samples[:, 0]) >= settings.min_vel_trans - 1e-4]


def _spaced(now: float, change: float, lowest: float, highest: float, count: int) -> np.ndarray:
    """``count`` values within reach of ``now`` and within limits; 0 is one more if it lies between them."""
    low = min(max(now - change, lowest), highest)
    high = max(min(now + change, highest), low)
    values = np.linspace(low, high, count)
    if low < 0.0 < high:
        values = np.sort(np.append(values, 0.0))
    return values


@numba.njit(cache=True)
def _score(
    costs,
    origin_x,
    origin_y,
    resolution,
    outline_xy,
    start,
    samples,
    sim_time,
    granularity,
    angular_granularity,
    from_path,
    from_goal,
    from_nose_goal,
    nose,
    scales,
):
    """Cost of each sample, negative if it must not be driven."""
    path_scale, goal_scale, alignment_scale, obstacle_scale = scales
    contacts = count_contacts(costs, origin_x, origin_y, resolution, outline_xy, start[0], start[1], start[2])
    scores = np.empty(samples.shape[0])
    for i in range(samples.shape[0]):
        v, omega = samples[i]
        poses = arc(start, v, omega, sim_time, granularity, angular_granularity)
        highest = _obstacle_cost(costs, origin_x, origin_y, resolution, outline_xy, poses, contacts)
        if highest < 0.0:
            scores[i] = REJECTED
            continue
        x, y, yaw = poses[-1]
        to_path = _at(from_path, origin_x, origin_y, resolution, x, y)
        to_goal = _at(from_goal, origin_x, origin_y, resolution, x, y)
        if to_path >= UNREACHABLE or to_goal >= UNREACHABLE:
            scores[i] = REJECTED
            continue
        nose_x, nose_y = x + nose * math.cos(yaw), y + nose * math.sin(yaw)
        scores[i] = (
            obstacle_scale * highest
            + path_scale * to_path
            + goal_scale * to_goal
            + alignment_scale * _at(from_path, origin_x, origin_y, resolution, nose_x, nose_y)
            + goal_scale * _at(from_nose_goal, origin_x, origin_y, resolution, nose_x, nose_y)
        )
    return scores


@numba.njit(cache=True)
def _obstacle_cost(costs, origin_x, origin_y, resolution, outline_xy, poses, contacts):
    """Highest cost below the footprint along a trajectory, REJECTED if it collides.

    A robot that touches something already, at so many points of its outline, may move as long as it never
    touches at more.
    """
    highest = 0.0
    for j in range(poses.shape[0]):
        x, y, yaw = poses[j]
        if contacts > 0:
            now = count_contacts(costs, origin_x, origin_y, resolution, outline_xy, x, y, yaw)
            if now > contacts:
                return REJECTED
            contacts = now
            highest = float(INSCRIBED)
        else:
            cost = footprint_cost(costs, origin_x, origin_y, resolution, outline_xy, x, y, yaw)
            if cost == COLLISION:
                return REJECTED
            highest = max(highest, float(cost))
    return highest


@numba.njit(cache=True)
def _at(distances, origin_x, origin_y, resolution, x, y):
    """Distance in cells, interpolated between cell centres so that small motions count too."""
    rows, cols = distances.shape
    row, col = int((y - origin_y) / resolution), int((x - origin_x) / resolution)
    if row < 0 or row >= rows or col < 0 or col >= cols:
        return UNREACHABLE
    nearest = distances[row, col]
    u, w = (y - origin_y) / resolution - 0.5, (x - origin_x) / resolution - 0.5
    row, col = int(math.floor(u)), int(math.floor(w))
    if row < 0 or row >= rows - 1 or col < 0 or col >= cols - 1:
        return nearest
    u, w = u - row, w - col
    value = (1.0 - u) * ((1.0 - w) * distances[row, col] + w * distances[row, col + 1]) + u * (
        (1.0 - w) * distances[row + 1, col] + w * distances[row + 1, col + 1]
    )
    return value if value < UNREACHABLE / rows / cols else nearest
