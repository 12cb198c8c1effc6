"""Numba kernels that roll out control sequences and compute their costs."""

import math
from typing import Any, NamedTuple, Tuple

import numba
import numpy as np

from move_base_lite.control.mppi.scene import (
    ARRAYS,
    FAR,
    MppiScene,
    dynamic_obstacle_clearance,
    footprint_clearance,
    value_at,
)

# Distance ahead of the robot over which the slope of the cost to go is taken [m].
SLOPE_DISTANCE = 0.3
# Clearance of the robot's circle at which no footprint point can be in collision [cells].
FREE_MARGIN_CELLS = 1.5
# Angle below which sine and cosine are computed by their series [rad].
SMALL_ANGLE = 0.2
# Minimum speed in the obstacle cost, so that standing near an obstacle costs too [m/s].
MIN_EXPOSURE_SPEED = 0.1
# Part of the samples that is evaluated while the mean of the last period is unobstructed.
UNOBSTRUCTED_DIVISOR = 2
# Cost to go above that of the start at which places that seem unreachable are valued among dynamic obstacles
# [m]: what encloses them moves on, while a contact is final.
MAX_DETOUR = 2.0
# Position uncertainty of a dynamic obstacle [m], and its growth with prediction time [m/s].
UNCERTAINTY, UNCERTAINTY_GROWTH = 0.1, 0.1


class MotionLimits(NamedTuple):
    """Control period and limits of motion; see MppiSettings.

    Attributes:
        period: Control period [s].
        lowest_v: Lowest speed, negative if the robot may drive backwards [m/s].
        highest_v: Highest speed [m/s].
        highest_omega: Highest turn rate [rad/s].
        acceleration: Highest acceleration [m/s^2].
        turn_acceleration: Highest angular acceleration [rad/s^2].
        approach_time: Minimum time to cover the remaining clearance [s].
        creep_v: Speed allowed at any clearance [m/s].
    """

    period: float
    lowest_v: float
    highest_v: float
    highest_omega: float
    acceleration: float
    turn_acceleration: float
    approach_time: float
    creep_v: float


class CostWeights(NamedTuple):
    """Weights of the cost terms; costs are in metres of remaining path. See MppiSettings.

    Attributes:
        safe_distance: Footprint clearance below which driving costs more [m].
        obstacle: Cost per metre driven in contact with an obstacle.
        turn: Weight of the squared turn rate [s].
        backward: Cost per metre driven backwards.
        heading: Cost of a final heading away from the goal [m].
        delay: Weight of the remaining path over time [1/s].
        dynamic_obstacle: Cost of a collision with a dynamic obstacle.
        dynamic_obstacle_distance: Clearance from dynamic obstacles below which driving costs more [m].
    """

    safe_distance: float
    obstacle: float
    turn: float
    backward: float
    heading: float
    delay: float
    dynamic_obstacle: float
    dynamic_obstacle_distance: float


class RolloutStart(NamedTuple):
    """Values that all rollouts from one state share.

    Attributes:
        steps: Control periods of the horizon.
        exact_below: Static clearance above which the exact value does not matter [m].
        dynamic_exact_below: The same for dynamic obstacles [m].
        min_clearance: Static clearance below which the robot is in collision [m].
        min_dynamic_clearance: The same for dynamic obstacles [m].
        seconds_to_stop: Stopping time from the start [s].
        max_to_go: Highest cost to go, instead of that of unknown places [m].
    """

    steps: int
    exact_below: float
    dynamic_exact_below: float
    min_clearance: float
    min_dynamic_clearance: float
    seconds_to_stop: float
    max_to_go: float


# State of a rollout: pose, cosine and sine of its yaw, velocity, cost so far, collision risk so far,
# clearance (see footprint_clearance), cost to go.
MOTION = np.dtype([(name, float) for name in "x y yaw c s v omega cost risk clearance to_go".split()])

# For what each step of each rollout calls: without inlining, numba passes some 50 arguments per call.
_inlined = numba.njit(cache=True, forceinline=True)


@numba.njit(cache=True)
def best_controls(
    noise, mean, extra_controls, start, temperature, clearance, to_go, outline_xy, dynamic_obstacles, numbers
):
    """Compute the weighted mean of the sampled controls, or the best sample if that is better.

    Arguments from ``clearance`` on are those of kernel_arguments: named tuples make numba's dispatch slow.

    Args:
        noise: (M, N, 2), deviations of v, omega, added to ``mean``.
        mean: (N, 2), controls v, omega of the last period, shifted by one step.
        extra_controls: (L, N, 2), controls that are evaluated without noise.
        start: (5,) of x, y, yaw, v, omega.
        temperature: Cost above the best sample's at which a sample's weight falls to 1/e [m].
        clearance: See MppiScene.
        to_go: See MppiScene.
        outline_xy: See MppiScene.
        dynamic_obstacles: See MppiScene.
        numbers: The numbers of MppiScene, MotionLimits and CostWeights.

    Returns:
        Controls (N, 2), cost, poses (N + 1, 3) and speeds (N, 2); the cost is inf if all samples collide.
    """
    problem = _unpack(clearance, to_go, outline_xy, dynamic_obstacles, numbers)
    if is_unobstructed(mean, start, problem):
        noise = noise[: max(1, len(noise) // UNOBSTRUCTED_DIVISOR)]
    samples = noise, mean, extra_controls
    costs, average, total = costs_of(samples, start, problem), np.zeros(mean.shape), 0.0
    best = np.argmin(costs)
    lowest, poses, speeds = costs[best], np.empty((len(mean) + 1, 3)), np.empty(mean.shape)
    if lowest < np.inf:
        for i in range(len(costs)):
            weight = math.exp((lowest - costs[i]) / temperature)
            total += weight
            if weight > 0.0:
                _add_weighted(average, weight, i, samples)
        average /= total
        lowest = drive(average, start, problem, poses, speeds)
        if not lowest <= costs[best] + temperature:
            average[:] = 0.0
            _add_weighted(average, 1.0, best, samples)
            lowest = drive(average, start, problem, poses, speeds)
    return average, lowest, poses, speeds


def kernel_arguments(scene: MppiScene, limits: MotionLimits, weights: CostWeights) -> Tuple[Any, ...]:
    """Pack the arguments of ``best_controls`` after ``temperature``.

    Args:
        scene: Surroundings of the robot.
        limits: Control period and limits of motion.
        weights: Weights of the cost terms.
    """
    arrays, numbers = scene[:ARRAYS], scene[ARRAYS:]
    return (*arrays, np.array([*numbers, *limits, *weights]))


@numba.njit(cache=True)
def _unpack(clearance, to_go, outline_xy, dynamic_obstacles, n):
    arrays = clearance, to_go, outline_xy, dynamic_obstacles
    scene = MppiScene(*arrays, n[0], n[1], n[2], n[3], n[4], n[5], n[6])
    limits = MotionLimits(n[7], n[8], n[9], n[10], n[11], n[12], n[13], n[14])
    weights = CostWeights(n[15], n[16], n[17], n[18], n[19], n[20], n[21], n[22])
    return scene, limits, weights


@numba.njit(cache=True)
def is_unobstructed(controls, start, problem):
    """Return whether no obstacle adds to the cost of a rollout, nor can one that moves.

    Args:
        controls: (N, 2), controls v, omega.
        start: (5,) of x, y, yaw, v, omega.
        problem: Tuple of MppiScene, MotionLimits and CostWeights.
    """
    if problem[0].dynamic_obstacles.shape[0] > 0:
        return False
    motions = np.empty(1, MOTION)
    shared = _start_rollout(motions, len(controls), start, problem)
    motion = motions[0]
    for step in range(shared.steps):
        requested = controls[step, 0], controls[step, 1]
        if motion.clearance < shared.exact_below or not _advance(motion, step, requested, shared, problem):
            return False
    return motion.clearance >= shared.exact_below


@_inlined
def _control_at(i, step, samples):
    """Control of sample ``i`` at a step."""
    noise, mean, extra_controls = samples
    if i < len(noise):
        return noise[i, step, 0] + mean[step, 0], noise[i, step, 1] + mean[step, 1]
    return extra_controls[i - len(noise), step, 0], extra_controls[i - len(noise), step, 1]


@numba.njit(cache=True)
def _add_weighted(average, weight, i, samples):
    for step in range(average.shape[0]):
        v, omega = _control_at(i, step, samples)
        average[step, 0] += weight * v
        average[step, 1] += weight * omega


@numba.njit(cache=True)
def costs_of(samples, start, problem):
    """Compute the cost of each sample, as ``drive`` does for one.

    All rollouts advance together, step by step: independent computations keep the processor's pipeline full.

    Args:
        samples: Tuple of ``noise``, ``mean`` and ``extra_controls`` (see best_controls).
        start: (5,) of x, y, yaw, v, omega.
        problem: Tuple of MppiScene, MotionLimits and CostWeights.

    Returns:
        Costs (M + L,) [m].
    """
    count = len(samples[0]) + len(samples[2])
    motions = np.empty(count, MOTION)
    shared = _start_rollout(motions, len(samples[1]), start, problem)
    costs, numbers = np.empty(count), np.arange(count)
    running = count
    for step in range(shared.steps):
        i = 0
        while i < running:
            if _advance(motions[i], step, _control_at(numbers[i], step, samples), shared, problem):
                i += 1
                continue
            costs[numbers[i]] = _cost_at_end(motions[i], problem)
            running -= 1
            motions[i], numbers[i] = motions[running], numbers[running]
    for i in range(running):
        costs[numbers[i]] = _cost_at_end(motions[i], problem)
    return costs


@numba.njit(cache=True)
def drive(requested, start, problem, poses, speeds):
    """Roll out controls and return their cost [m].

    The cost is inf if the robot hits a static obstacle before it could have stopped. A robot that starts in
    collision may move as long as the number of contacts does not rise.

    Args:
        requested: (N, 2), controls v, omega.
        start: (5,) of x, y, yaw, v, omega.
        problem: Tuple of MppiScene, MotionLimits and CostWeights.
        poses: (N + 1, 3), filled with the predicted poses x, y, yaw.
        speeds: (N, 2), filled with the reachable v, omega, limited by the clearance.
    """
    motions = np.empty(1, MOTION)
    shared = _start_rollout(motions, len(requested), start, problem)
    motion, poses[0] = motions[0], start[:3]
    for step in range(shared.steps):
        if not _advance(motion, step, (requested[step, 0], requested[step, 1]), shared, problem):
            poses[step + 1 :], speeds[step:] = poses[step], 0.0
            break
        poses[step + 1] = motion.x, motion.y, motion.yaw
        speeds[step] = motion.v, motion.omega
    return _cost_at_end(motion, problem)


@numba.njit(cache=True)
def _start_rollout(motions, steps, start, problem):
    """Set all motions to the start, and compute what the rollouts share."""
    scene, limits, weights = problem
    x, y, yaw, v, omega = start
    c, s, cell = math.cos(yaw), math.sin(yaw), 1.0 / scene.cells_per_metre
    exact_below = _exact_below(scene, limits, weights)
    dynamic_exact_below = max(
        weights.dynamic_obstacle_distance, cell + _position_uncertainty(steps * limits.period)
    )
    clearance = footprint_clearance(scene, x, y, c, s, exact_below)
    min_dynamic_clearance = min(cell, dynamic_obstacle_clearance(scene, x, y, c, s, 0.0, dynamic_exact_below))
    to_go, max_to_go = value_at(scene.to_go, scene, x, y), FAR
    if scene.dynamic_obstacles.shape[0] > 0:
        to_go = min(to_go, scene.to_go.shape[0] * cell)
        max_to_go = to_go + MAX_DETOUR
    for motion in motions:
        motion.x, motion.y, motion.yaw, motion.c, motion.s = x, y, yaw, c, s
        motion.v, motion.omega, motion.cost, motion.risk = v, omega, 0.0, 0.0
        motion.clearance, motion.to_go = clearance, to_go
    return RolloutStart(
        steps,
        exact_below,
        dynamic_exact_below,
        min(cell, clearance),
        min_dynamic_clearance,
        abs(v) / limits.acceleration,
        max_to_go,
    )


@_inlined
def _advance(motion, step, requested, shared, problem):
    """Advance a rollout by one period; False if it ends there in a collision.

    The robot then stays where it was, which costs the remaining time; inf if it could not have stopped.
    """
    scene, limits, weights = problem
    dt, seconds = limits.period, (step + 1) * limits.period
    v, omega = _reachable_speeds(motion.v, motion.omega, requested, motion.clearance, limits)
    turn = _cos_sin(0.5 * omega * dt)
    ahead_c, ahead_s = _rotate(motion.c, motion.s, turn)
    c, s = _rotate(ahead_c, ahead_s, turn)
    x, y = motion.x + v * dt * ahead_c, motion.y + v * dt * ahead_s
    clearance = footprint_clearance(scene, x, y, c, s, shared.exact_below)
    obstacle_clearance = dynamic_obstacle_clearance(scene, x, y, c, s, seconds, shared.dynamic_exact_below)
    left = 1.0 - step / shared.steps
    risk = max(motion.risk, _risk(obstacle_clearance - shared.min_dynamic_clearance, seconds))
    cost = motion.cost + left * weights.dynamic_obstacle * (risk - motion.risk)
    if clearance < shared.min_clearance or risk == 1.0:
        if clearance < shared.min_clearance and (step - 1) * dt < shared.seconds_to_stop:
            cost = np.inf
        motion.cost = cost + left * (1.0 + weights.delay * shared.steps * dt * motion.to_go)
        return False
    to_go = min(value_at(scene.to_go, scene, x, y), shared.max_to_go)
    motion.x, motion.y, motion.yaw, motion.c, motion.s = x, y, motion.yaw + omega * dt, c, s
    motion.v, motion.omega, motion.risk, motion.clearance, motion.to_go = v, omega, risk, clearance, to_go
    motion.cost = _step_cost(cost, v, omega, clearance, obstacle_clearance, to_go, limits, weights)
    return True


@numba.njit(cache=True)
def _cost_at_end(motion, problem):
    scene, _, weights = problem
    ahead_of_goal = _slope(scene, motion.x, motion.y, motion.yaw, motion.to_go)
    return motion.cost + motion.to_go + weights.heading * ahead_of_goal


@numba.njit(cache=True)
def _exact_below(scene, limits, weights):
    """Clearance above which the exact value does not matter: no cost, no collision [m]."""
    if scene.circumscribed_radius - scene.inscribed_radius < 1.0 / scene.cells_per_metre:
        return FREE_MARGIN_CELLS / scene.cells_per_metre
    return max(weights.safe_distance, limits.highest_v * limits.approach_time, 1.0 / scene.cells_per_metre)


@_inlined
def _reachable_speeds(v, omega, requested, clearance, limits):
    """Speeds after a period in which ``requested`` is commanded, limited by the clearance."""
    allowed_v = _max_speed_at(clearance, limits)
    v = _approach(v, requested[0], limits.acceleration * limits.period)
    v = min(max(v, limits.lowest_v, -allowed_v), allowed_v)
    omega = _approach(omega, requested[1], limits.turn_acceleration * limits.period)
    return v, min(max(omega, -limits.highest_omega), limits.highest_omega)


@_inlined
def _cos_sin(angle):
    """Cosine and sine of an angle; of small ones by their series, exact to the last bits."""
    if abs(angle) > SMALL_ANGLE:
        return math.cos(angle), math.sin(angle)
    square = angle * angle
    c = 1.0 - square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)))
    return c, angle * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)))


@_inlined
def _rotate(c, s, turn):
    """Cosine and sine of a heading after a turn, given as cosine and sine."""
    by_c, by_s = turn
    return c * by_c - s * by_s, s * by_c + c * by_s


@_inlined
def _step_cost(cost, v, omega, clearance, obstacle_clearance, to_go, limits, weights):
    """The cost after one more period: clearance, delay, turning, driving backwards."""
    dt = limits.period
    if clearance < weights.safe_distance:
        nearness = _nearness(clearance, weights.safe_distance)
        cost += weights.obstacle * nearness * nearness * (abs(v) + MIN_EXPOSURE_SPEED) * dt
    if obstacle_clearance < weights.dynamic_obstacle_distance:
        # Does not depend on the speed: standing still does not increase the distance at which others pass.
        nearness = _nearness(obstacle_clearance, weights.dynamic_obstacle_distance)
        cost += weights.obstacle * nearness * nearness * limits.highest_v * dt
    return cost + dt * (weights.delay * to_go + weights.turn * omega * omega - weights.backward * min(v, 0.0))


@_inlined
def _risk(clearance, seconds):
    """Collision probability with a dynamic obstacle predicted at a clearance, ``seconds`` from now."""
    return min(max(0.5 - 0.5 * clearance / _position_uncertainty(seconds), 0.0), 1.0)


@numba.njit(cache=True)
def _position_uncertainty(seconds):
    """Position uncertainty of a dynamic obstacle ``seconds`` ahead [m]."""
    return UNCERTAINTY + UNCERTAINTY_GROWTH * seconds


@numba.njit(cache=True)
def _slope(scene, x, y, yaw, to_go):
    """Slope of the cost to go ahead of the robot: -1 if it faces the goal, 1 if it faces away."""
    ahead = value_at(
        scene.to_go, scene, x + SLOPE_DISTANCE * math.cos(yaw), y + SLOPE_DISTANCE * math.sin(yaw)
    )
    return min(max((ahead - to_go) / SLOPE_DISTANCE, -1.0), 1.0)


@numba.njit(cache=True)
def _nearness(clearance, safe_distance):
    """1 in contact, 0 at the safe distance."""
    return 1.0 - max(clearance, 0.0) / safe_distance


@numba.njit(cache=True)
def _approach(value, requested, change):
    return min(max(requested, value - change), value + change)


@numba.njit(cache=True)
def _max_speed_at(clearance, limits):
    """Maximum speed at a clearance [m/s]."""
    if limits.approach_time > 0.0:
        return min(limits.highest_v, max(limits.creep_v, clearance / limits.approach_time))
    return limits.highest_v
