"""The dynamic window approach (Fox, Burgard and Thrun, 1997) with the critics of dwa_local_planner."""

import math

import numpy as np

from move_base_lite.control.dwa.critics import Scene, Ways, Weights, scores_of
from move_base_lite.control.dwa.exploration import Attempts
from move_base_lite.control.dwa.map_grid import distances_to
from move_base_lite.control.dwa.settings import DwaSettings
from move_base_lite.control.local_planner import Plan, Situation, Trajectory
from planar import Twist2

SHORTEST_HORIZON = 0.5


class DynamicWindow:
    """A LocalPlanner that chooses among the velocities within reach, each kept for a while.

    As in the official one, whatever moves is where it is now.
    """

    def __init__(self, settings: DwaSettings, period: float):
        self._settings = settings
        self._period = period

    def follow(self, situation: Situation, plan: Plan, limits: Twist2) -> Trajectory:
        """The cheapest velocity; looks no further ahead than the end, or the robot would creep towards it."""
        horizon = min(max(plan.distance_left / limits.v, SHORTEST_HORIZON), self._settings.sim_time)
        return self._explored(situation, plan.path_xy, limits, horizon).best()

    def _explored(
        self, situation: Situation, path_xy: np.ndarray, limits: Twist2, horizon: float
    ) -> Attempts:
        """All velocities within reach, followed for ``horizon`` seconds, with their scores."""
        settings, costmap, base_pose = self._settings, situation.costmap, situation.base_in_local
        scene = _scene(situation, path_xy, settings.forward_point_distance)
        goal_x, goal_y = path_xy[-1]
        near_goal = scene.nose * math.sqrt(settings.cheat_factor)
        is_far_from_goal = math.hypot(goal_x - base_pose.x, goal_y - base_pose.y) > near_goal
        ways = Ways(base_pose.as_array(), horizon, settings.sim_granularity, settings.angular_sim_granularity)
        velocities = velocity_samples(settings, situation.twist, limits, self._period)
        weights = _weights(settings, costmap.window.resolution, is_far_from_goal)
        scores = scores_of(velocities, ways, scene, weights)
        return Attempts(settings, ways, velocities, scores, costmap.window, scene)


def _scene(situation: Situation, path_xy: np.ndarray, nose: float) -> Scene:
    """The costmap, and the distances through it to the path (N, 2) and to its end."""
    costmap, base_pose = situation.costmap, situation.base_in_local
    window = costmap.window
    goal_x, goal_y = path_xy[-1]
    to_goal = math.atan2(goal_y - base_pose.y, goal_x - base_pose.x)
    nose_goal_xy = path_xy[-1] + nose * np.array([math.cos(to_goal), math.sin(to_goal)])
    return Scene(
        costs=costmap.costs,
        origin_x=window.origin_x,
        origin_y=window.origin_y,
        resolution=window.resolution,
        outline_xy=costmap.outline_xy,
        from_path=distances_to(costmap.costs, window, path_xy),
        from_goal=distances_to(costmap.costs, window, path_xy[-1:]),
        from_nose_goal=distances_to(costmap.costs, window, nose_goal_xy[None, :]),
        nose=nose,
    )


def _weights(settings: DwaSettings, resolution: float, is_far_from_goal: bool) -> Weights:
    """The nose is to lie on the path only as long as the goal is far."""
    path_scale = resolution * settings.path_distance_bias
    goal_scale = resolution * settings.goal_distance_bias
    return Weights(
        obstacles=settings.occdist_scale,
        path_distance=path_scale,
        goal_distance=goal_scale,
        path_alignment=path_scale if is_far_from_goal else 0.0,
        goal_alignment=goal_scale,
        twirling=settings.twirling_scale,
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
