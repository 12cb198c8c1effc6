"""Model predictive path integral control (Williams et al., 2017) on a field of the cost to go."""

import math

import numpy as np

from move_base_lite.control.local_planner import ControlContext, Plan, Trajectory
from move_base_lite.control.mppi.rollout import CostWeights, MotionLimits, best_controls, kernel_arguments
from move_base_lite.control.mppi.samples import KNOTS, arc_controls, evasive_controls, smooth_noise
from move_base_lite.control.mppi.scene import scene_of
from move_base_lite.control.mppi.settings import MppiSettings
from move_base_lite.errors import ControlError
from planar import Twist2


class MppiPlanner:
    """A LocalPlanner: the cost-weighted mean of many random control sequences, warm-started from the last.

    The cost of a sequence is the cost to go at its end, through free cells and away from obstacles [m], plus
    penalties for small clearance, turning and driving backwards. A rollout ends at a collision; it is invalid
    if the robot could not have stopped before. Dynamic obstacles are predicted at constant velocity with
    growing uncertainty; while there are any, evasive sequences are evaluated too. The noise is drawn once,
    from the seed. There are no trajectory samples to show.
    """

    def __init__(self, settings: MppiSettings, period: float):
        """Draw the noise.

        Args:
            settings: Horizon, numbers of samples, limits and weights.
            period: Control period [s].
        """
        self._settings = settings
        self._period = period
        steps = max(KNOTS, round(settings.horizon / period))
        self._noise = smooth_noise(np.random.default_rng(settings.seed), settings, steps)
        self._arc_controls = arc_controls(settings, steps)
        self._arcs_and_evasions = np.concatenate((self._arc_controls, evasive_controls(settings, steps)))
        self._mean = np.zeros((steps, 2))
        self._weights = CostWeights(
            safe_distance=settings.safe_distance,
            obstacle=settings.obstacle_weight,
            turn=settings.turn_weight,
            backward=settings.backward_weight,
            heading=settings.heading_weight,
            delay=settings.delay_weight,
            dynamic_obstacle=settings.dynamic_obstacle_weight,
            dynamic_obstacle_distance=settings.dynamic_obstacle_distance,
        )

    def follow(self, context: ControlContext, plan: Plan, limits: Twist2) -> Trajectory:
        """Compute the velocity for the next period (see LocalPlanner.follow).

        It is that of the weighted mean of the samples, or of the best sample if that is better.
        """
        twist = context.twist
        start = np.array([*context.base_in_local.as_array(), twist.v, twist.omega])
        scene = scene_of(context, plan, self._settings.use_global_costmap)
        problem = kernel_arguments(scene, self._limits(limits), self._weights)
        extra_controls = self._arcs_and_evasions if len(context.dynamic_obstacles) else self._arc_controls
        mean, cost, poses, speeds = best_controls(
            self._noise, self._mean, extra_controls, start, self._settings.temperature, *problem
        )
        if not math.isfinite(cost):
            self._mean[:] = 0.0
            raise ControlError("every sampled trajectory leads into an obstacle")
        self._mean = np.concatenate((mean[1:], mean[-1:]))
        v, omega = map(float, speeds[0])
        return Trajectory(Twist2(v, omega), poses, float(cost))

    def _limits(self, max_speeds: Twist2) -> MotionLimits:
        settings = self._settings
        return MotionLimits(
            period=self._period,
            lowest_v=settings.min_vel_x,
            highest_v=max_speeds.v,
            highest_omega=max_speeds.omega,
            acceleration=settings.acc_lim_x,
            turn_acceleration=settings.acc_lim_theta,
            approach_time=settings.approach_time,
            creep_v=settings.creep_vel_x,
        )
