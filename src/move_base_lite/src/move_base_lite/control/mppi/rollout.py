"""A way of driving followed ahead, and what it costs. Kernels."""

import math
from typing import Any, NamedTuple, Tuple

import numba
import numpy as np

from move_base_lite.control.mppi.scene import ARRAYS, Scene, room_at, room_beside_movers, value_at

# Metres ahead at which the slope of the cost to go is felt.
NOSE = 0.3
# Cells between outline and obstacle, by the middle of the robot, with which no point of it is in one.
SURELY_FREE = 1.5
# Radians up to which a turn goes by its series.
SMALL_ANGLE = 0.2
# m/s that a robot counts as at least when it lingers near an obstacle.
CREEPING = 0.1
# See _doubt: m, and m/s for the time ahead.
DOUBT, DOUBT_GROWTH = 0.1, 0.1


class Limits(NamedTuple):
    """Of one period of so many seconds: m/s, rad/s, m/s^2, rad/s^2."""

    period: float
    lowest_v: float
    highest_v: float
    highest_omega: float
    acceleration: float
    turn_acceleration: float
    approach_time: float
    creep_v: float


class Weights(NamedTuple):
    """Of the costs, all in metres left to drive (see MppiSettings)."""

    safe_distance: float
    obstacle: float
    turn: float
    backward: float
    heading: float
    delay: float
    mover: float
    mover_distance: float


@numba.njit(cache=True)
def best_way(noise, mean, others, start, temperature, clearance, to_go, outline_xy, movers, numbers):
    """The mean of the ways tried, weighted by what each costs, or the best of them if that is better.

    Tried are ``mean`` (N, 2) with ``noise`` (M, N, 2) and ``others`` (L, N, 2), in this order.

    Returns the speeds asked for (N, 2), cost, poses and speeds (see drive); the cost is inf if all hit
    something. Takes arrays of a scene one by one, and all numbers in one: names take numba long to look at.
    """
    scene, limits, weights = _named(clearance, to_go, outline_xy, movers, numbers)
    count, steps = len(noise) + len(others), len(mean)
    poses, speeds, costs = np.empty((steps + 1, 3)), np.empty((steps, 2)), np.empty(count)
    way, average, total = np.empty((steps, 2)), np.zeros((steps, 2)), 0.0
    for i in range(count):
        _take(i, noise, mean, others, way)
        costs[i] = drive(way, start, scene, limits, weights, poses, speeds)
    best = np.argmin(costs)
    lowest = costs[best]
    if lowest < np.inf:
        for i in range(count):
            weight = math.exp((lowest - costs[i]) / temperature)
            total += weight
            if weight > 0.0:
                _take(i, noise, mean, others, way)
                _add(average, weight, way)
        average /= total
        lowest = drive(average, start, scene, limits, weights, poses, speeds)
        if not lowest <= costs[best] + temperature:
            _take(best, noise, mean, others, average)
            lowest = drive(average, start, scene, limits, weights, poses, speeds)
    return average, lowest, poses, speeds


def arguments_of(scene: Scene, limits: Limits, weights: Weights) -> Tuple[Any, ...]:
    """What ``best_way`` takes of them."""
    arrays, numbers = scene[:ARRAYS], scene[ARRAYS:]
    return (*arrays, np.array([*numbers, *limits, *weights]))


@numba.njit(cache=True)
def _named(clearance, to_go, outline_xy, movers, n):
    scene = Scene(clearance, to_go, outline_xy, movers, n[0], n[1], n[2], n[3], n[4])
    limits = Limits(n[5], n[6], n[7], n[8], n[9], n[10], n[11], n[12])
    return scene, limits, Weights(n[13], n[14], n[15], n[16], n[17], n[18], n[19], n[20])


@numba.njit(cache=True)
def _take(i, noise, mean, others, way):
    """Fills in the way (N, 2) number ``i`` of those that are tried."""
    for step in range(mean.shape[0]):
        for axis in range(2):
            if i < len(noise):
                way[step, axis] = noise[i, step, axis] + mean[step, axis]
            else:
                way[step, axis] = others[i - len(noise), step, axis]


@numba.njit(cache=True)
def _add(average, weight, way):
    for step in range(average.shape[0]):
        average[step, 0] += weight * way[step, 0]
        average[step, 1] += weight * way[step, 1]


@numba.njit(cache=True)
def drive(wanted, start, scene, limits, weights, poses, speeds):
    """The cost of a robot that is asked for the speeds ``wanted`` (N, 2), in metres left to drive.

    Fills in the poses (N + 1, 3) and speeds (N, 2), those it can reach, cut to what its clearance allows; it
    is inf if it hits what stays before it could have stopped. In touch it may move if no more points touch.
    """
    steps, dt = wanted.shape[0], limits.period
    x, y, yaw, v, omega = start
    c, s, poses[0] = math.cos(yaw), math.sin(yaw), (x, y, yaw)
    cell, enough = 1.0 / scene.cells_per_metre, _exact_below(scene, limits, weights)
    aside = max(weights.mover_distance, cell + _doubt(steps * dt))
    still_room = room_at(scene, x, y, c, s, enough)
    least_room, least_aside = min(cell, still_room), min(cell, room_beside_movers(scene, x, y, 0.0, aside))
    cost, risk, seconds_to_stop = 0.0, 0.0, abs(v) / limits.acceleration
    to_go = value_at(scene.to_go, scene, x, y)
    for step in range(steps):
        v, omega = _reached(v, omega, wanted[step], still_room, limits)
        ahead_c, ahead_s = _turned(c, s, 0.5 * omega * dt)
        x_next, y_next, yaw_next = x + v * dt * ahead_c, y + v * dt * ahead_s, yaw + omega * dt
        c, s = _turned(ahead_c, ahead_s, 0.5 * omega * dt)
        still_room = room_at(scene, x_next, y_next, c, s, enough)
        passing_room = room_beside_movers(scene, x_next, y_next, (step + 1) * dt, aside)
        left, risk_before = 1.0 - step / steps, risk
        risk = max(risk, _risk(passing_room - least_aside, (step + 1) * dt))
        cost += left * weights.mover * (risk - risk_before)
        if still_room < least_room or risk == 1.0:
            if still_room < least_room and (step - 1) * dt < seconds_to_stop:
                return np.inf
            cost += left * (1.0 + weights.delay * steps * dt * to_go)
            poses[step + 1 :], speeds[step:] = poses[step], 0.0
            break
        x, y, yaw = x_next, y_next, yaw_next
        poses[step + 1], speeds[step] = (x, y, yaw), (v, omega)
        to_go = value_at(scene.to_go, scene, x, y)
        cost = _with_step(cost, v, omega, still_room, passing_room, to_go, limits, weights)
    return cost + to_go + weights.heading * _slope(scene, x, y, yaw, to_go)


@numba.njit(cache=True)
def _exact_below(scene, limits, weights):
    """Metres of room above which more makes no difference, or a round robot surely touches nothing."""
    if scene.circumscribed_radius - scene.inscribed_radius < 1.0 / scene.cells_per_metre:
        return SURELY_FREE / scene.cells_per_metre
    return max(weights.safe_distance, limits.highest_v * limits.approach_time, 1.0 / scene.cells_per_metre)


@numba.njit(cache=True)
def _reached(v, omega, wanted, room, limits):
    """The speeds that a robot with so much ``room`` has after a period in which it is asked for others."""
    allowed_v = _highest_speed_in(room, limits)
    v = _towards(v, wanted[0], limits.acceleration * limits.period)
    v = min(max(v, limits.lowest_v, -allowed_v), allowed_v)
    omega = _towards(omega, wanted[1], limits.turn_acceleration * limits.period)
    return v, min(max(omega, -limits.highest_omega), limits.highest_omega)


@numba.njit(cache=True)
def _turned(c, s, angle):
    """Cosine and sine of a heading turned by an angle; small ones by their series, to the last bits."""
    if abs(angle) > SMALL_ANGLE:
        by_c, by_s = math.cos(angle), math.sin(angle)
    else:
        square = angle * angle
        by_c = 1.0 - square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)))
        by_s = angle * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)))
    return c * by_c - s * by_s, s * by_c + c * by_s


@numba.njit(cache=True)
def _with_step(cost, v, omega, still_room, passing_room, to_go, limits, weights):
    """The cost with that of one period: nearness to what stays and to what moves, delay, turning, backing."""
    dt = limits.period
    if still_room < weights.safe_distance:
        nearness = _nearness(still_room, weights.safe_distance)
        cost += weights.obstacle * nearness * nearness * (abs(v) + CREEPING) * dt
    if passing_room < weights.mover_distance:
        # Standing still makes nobody pass at a greater distance.
        nearness = _nearness(passing_room, weights.mover_distance)
        cost += weights.obstacle * nearness * nearness * limits.highest_v * dt
    return cost + dt * (weights.delay * to_go + weights.turn * omega * omega - weights.backward * min(v, 0.0))


@numba.njit(cache=True)
def _risk(room, seconds):
    """How likely what moves is touched, so many seconds from now, if it is expected ``room`` metres away."""
    return min(max(0.5 - 0.5 * room / _doubt(seconds), 0.0), 1.0)


@numba.njit(cache=True)
def _doubt(seconds):
    """Metres by which what moves may be nearer than expected, so many seconds ahead."""
    return DOUBT + DOUBT_GROWTH * seconds


@numba.njit(cache=True)
def _slope(scene, x, y, yaw, to_go):
    """How much the cost to go rises ahead of the robot: -1 if it faces the goal, 1 if it faces away."""
    ahead = value_at(scene.to_go, scene, x + NOSE * math.cos(yaw), y + NOSE * math.sin(yaw))
    return min(max((ahead - to_go) / NOSE, -1.0), 1.0)


@numba.njit(cache=True)
def _nearness(room, safe_distance):
    """1 in touch, 0 at the safe distance."""
    return 1.0 - max(room, 0.0) / safe_distance


@numba.njit(cache=True)
def _towards(value, wanted, change):
    return min(max(wanted, value - change), value + change)


@numba.njit(cache=True)
def _highest_speed_in(room, limits):
    """That the limits and ``room`` metres of clearance allow."""
    if limits.approach_time > 0.0:
        return min(limits.highest_v, max(limits.creep_v, room / limits.approach_time))
    return limits.highest_v
