"""Model predictive path integral control (Williams et al., 2017) on a field of the cost to go."""

import math

import numpy as np

from move_base_lite.control.local_planner import Plan, Situation, Trajectory
from move_base_lite.control.mppi.rollout import Limits, Weights, arguments_of, best_way
from move_base_lite.control.mppi.samples import KNOTS, evasions, fan, smooth_noise
from move_base_lite.control.mppi.scene import scene_of
from move_base_lite.control.mppi.settings import MppiSettings
from move_base_lite.errors import ControlError
from planar import Twist2


class PathIntegral:
    """A LocalPlanner that drives the mean of many random ways, weighted by what each costs, and starts the
    next from it.

    What a way costs is what is left to drive at its end, through free cells and shy of obstacles, in metres,
    with penalties for nearness, turning and driving backwards. A way that touches something ends there; if
    the robot could not stop before, it does not count. What moves is expected where it will be by then, the
    less surely the later; where anything does, ways that evade it are tried as well. The random deviations
    are drawn once, from the seed. What was tried is not shown.
    """

    def __init__(self, settings: MppiSettings, period: float):
        self._settings = settings
        self._period = period
        steps = max(KNOTS, round(settings.horizon / period))
        self._noise = smooth_noise(np.random.default_rng(settings.seed), settings, steps)
        self._fan = fan(settings, steps)
        self._fan_and_evasions = np.concatenate((self._fan, evasions(settings, steps)))
        self._mean = np.zeros((steps, 2))
        self._weights = Weights(
            safe_distance=settings.safe_distance,
            obstacle=settings.obstacle_weight,
            turn=settings.turn_weight,
            backward=settings.backward_weight,
            heading=settings.heading_weight,
            delay=settings.delay_weight,
            mover=settings.mover_weight,
            mover_distance=settings.mover_distance,
        )

    def follow(self, situation: Situation, plan: Plan, limits: Twist2) -> Trajectory:
        """The mean of the ways tried, or the best of them if that is better."""
        twist = situation.twist
        start = np.array([*situation.base_in_local.as_array(), twist.v, twist.omega])
        scene = scene_of(situation, plan, self._settings.heed_global_costmap)
        problem = arguments_of(scene, self._limits(limits), self._weights)
        others = self._fan_and_evasions if len(situation.movers) else self._fan
        ways = (self._noise, self._mean, others)
        mean, cost, poses, speeds = best_way(*ways, start, self._settings.temperature, *problem)
        if not math.isfinite(cost):
            self._mean[:] = 0.0
            raise ControlError("every way tried leads into an obstacle")
        self._mean = np.concatenate((mean[1:], mean[-1:]))
        v, omega = map(float, speeds[0])
        return Trajectory(Twist2(v, omega), poses, float(cost))

    def _limits(self, highest: Twist2) -> Limits:
        settings = self._settings
        return Limits(
            period=self._period,
            lowest_v=settings.min_vel_x,
            highest_v=highest.v,
            highest_omega=highest.omega,
            acceleration=settings.acc_lim_x,
            turn_acceleration=settings.acc_lim_theta,
            approach_time=settings.approach_time,
            creep_v=settings.creep_vel_x,
        )
