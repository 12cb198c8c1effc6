"""The dynamic window approach (Fox, Burgard and Thrun, 1997) with the critics of dwa_local_planner."""

import math

import numpy as np

from move_base_lite.control.dwa.critics import ArcSampling, CriticWeights, DwaScene, scores_of
from move_base_lite.control.dwa.map_grid import distances_to
from move_base_lite.control.dwa.settings import DwaSettings
from move_base_lite.control.dwa.trajectory_samples import DwaTrajectorySamples
from move_base_lite.control.local_planner import ControlContext, Plan, Trajectory
from planar import Twist2

# Shortest simulated time near the goal [s].
SHORTEST_HORIZON = 0.5


class DwaPlanner:
    """A LocalPlanner that scores the velocities reachable in one period, each simulated for some time.

    Dynamic obstacles count where they are now, as in dwa_local_planner.
    """

    def __init__(self, settings: DwaSettings, period: float):
        """Create the planner.

        Args:
            settings: Limits, numbers of samples and weights.
            period: Control period [s].
        """
        self._settings = settings
        self._period = period

    def follow(self, context: ControlContext, plan: Plan, limits: Twist2) -> Trajectory:
        """Compute the velocity with the best score (see LocalPlanner.follow).

        A trajectory ends where the plan ends: the robot would creep there if it was simulated beyond.
        """
        horizon = min(max(plan.distance_left / limits.v, SHORTEST_HORIZON), self._settings.sim_time)
        return self._evaluate(context, plan.path_xy, limits, horizon).best()

    def _evaluate(
        self, context: ControlContext, path_xy: np.ndarray, limits: Twist2, horizon: float
    ) -> DwaTrajectorySamples:
        """Score all reachable velocities, each simulated for ``horizon`` seconds."""
        settings, costmap, base_pose = self._settings, context.costmap, context.base_in_local
        scene = _scene(context, path_xy, settings.forward_point_distance)
        goal_x, goal_y = path_xy[-1]
        near_goal = scene.forward_distance * math.sqrt(settings.cheat_factor)
        is_far_from_goal = math.hypot(goal_x - base_pose.x, goal_y - base_pose.y) > near_goal
        sampling = ArcSampling(
            base_pose.as_array(), horizon, settings.sim_granularity, settings.angular_sim_granularity
        )
        velocities = velocity_samples(settings, context.twist, limits, self._period)
        weights = _weights(settings, costmap.window.resolution, is_far_from_goal)
        scores = scores_of(velocities, sampling, scene, weights)
        return DwaTrajectorySamples(settings, sampling, velocities, scores, costmap.window, scene)


def _scene(context: ControlContext, path_xy: np.ndarray, forward_distance: float) -> DwaScene:
    """The costmap with the distances through it to the path (N, 2) and to its end."""
    costmap, base_pose = context.costmap, context.base_in_local
    window = costmap.window
    goal_x, goal_y = path_xy[-1]
    to_goal = math.atan2(goal_y - base_pose.y, goal_x - base_pose.x)
    goal_front_xy = path_xy[-1] + forward_distance * np.array([math.cos(to_goal), math.sin(to_goal)])
    return DwaScene(
        costs=costmap.costs,
        origin_x=window.origin_x,
        origin_y=window.origin_y,
        resolution=window.resolution,
        outline_xy=costmap.outline_xy,
        path_map=distances_to(costmap.costs, window, path_xy),
        goal_map=distances_to(costmap.costs, window, path_xy[-1:]),
        goal_front_map=distances_to(costmap.costs, window, goal_front_xy[None, :]),
        forward_distance=forward_distance,
    )


def _weights(settings: DwaSettings, resolution: float, is_far_from_goal: bool) -> CriticWeights:
    """Path alignment counts only far from the goal (cheat_factor)."""
    path_scale = resolution * settings.path_distance_bias
    goal_scale = resolution * settings.goal_distance_bias
    return CriticWeights(
        obstacles=settings.occdist_scale,
        path_distance=path_scale,
        goal_distance=goal_scale,
        path_alignment=path_scale if is_far_from_goal else 0.0,
        goal_alignment=goal_scale,
        twirling=settings.twirling_scale,
    )


def velocity_samples(settings: DwaSettings, twist: Twist2, max_speeds: Twist2, period: float) -> np.ndarray:
    """Sample the dynamic window.

    The controller does turns in place, so samples below ``min_vel_trans`` are dropped; a robot at rest may
    start at ``min_vel_trans`` even if the acceleration limit is lower.

    Args:
        settings: Limits and numbers of samples.
        twist: Present velocity.
        max_speeds: Speed limits [m/s, rad/s].
        period: Control period [s].

    Returns:
        Velocities (N, 2) of v [m/s] and omega [rad/s].
    """
    horizon = period if settings.use_dwa else settings.sim_time
    change = max(settings.acc_lim_x * horizon, settings.min_vel_trans - twist.v)
    v = _spaced_samples(twist.v, change, settings.min_vel_x, max_speeds.v, settings.vx_samples)
    limit = max_speeds.omega
    omega = _spaced_samples(
        twist.omega, settings.acc_lim_theta * horizon, -limit, limit, settings.vth_samples
    )
    samples = np.stack(np.meshgrid(v, omega, indexing="ij"), axis=-1).reshape(-1, 2)
    return samples[np.abs(samples[:, 0]) >= settings.min_vel_trans - 1e-4]


def _spaced_samples(now: float, change: float, lowest: float, highest: float, count: int) -> np.ndarray:
    """``count`` evenly spaced values within ``change`` of ``now`` and the limits; also 0 if it is between."""
    low = min(max(now - change, lowest), highest)
    high = max(min(now + change, highest), low)
    values = np.linspace(low, high, count)
    if low < 0.0 < high:
        values = np.sort(np.append(values, 0.0))
    return values
