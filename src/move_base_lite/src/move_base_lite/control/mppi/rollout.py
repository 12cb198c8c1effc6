"""A way of driving followed ahead, and what it costs. Kernels."""

import math
from typing import NamedTuple

import numba
import numpy as np

from move_base_lite.control.mppi.scene import room_at, room_beside_movers, value_at

# Radians of a turn, and metres, after which the footprint is checked anew.
CHECKED_ANGLE = 0.1
CHECKED_DISTANCE = 0.05
# Metres ahead at which the slope of the cost to go is felt.
NOSE = 0.3
# m/s that a robot counts as at least when it lingers near an obstacle.
CREEPING = 0.1


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


@numba.njit(cache=True)
def costs_of(samples, start, scene, limits, weights):
    costs = np.empty(samples.shape[0])
    for i in range(samples.shape[0]):
        costs[i] = drive(samples[i], start, scene, limits, weights)[0]
    return costs


@numba.njit(cache=True)
def drive(wanted, start, scene, limits, weights):
    """Cost, poses (N + 1, 3) and speeds (N, 2) of a robot that is asked for the speeds ``wanted`` (N, 2).

    The speeds are those it can reach, cut to what its clearance allows. The cost is inf if it hits what stays
    before it could have stopped. A robot in touch may move as long as it never touches at more points.
    """
    steps, dt = wanted.shape[0], limits.period
    poses, speeds = np.empty((steps + 1, 3)), np.zeros((steps, 2))
    x, y, yaw, v, omega = start
    poses[0] = x, y, yaw
    still_room = room_at(scene, x, y, yaw)
    least_room = min(scene.resolution, still_room, room_beside_movers(scene, x, y, 0.0))
    seconds_to_stop = abs(v) / limits.acceleration
    cost, moved, turned = 0.0, 0.0, 0.0
    to_go = value_at(scene.to_go, scene, x, y)
    for step in range(steps):
        v, omega = _reached(v, omega, wanted[step], still_room, limits)
        x_next, y_next, yaw_next = _moved(x, y, yaw, v, omega, dt)
        moved, turned = moved + abs(v) * dt, turned + abs(omega) * dt
        if moved > CHECKED_DISTANCE or turned > CHECKED_ANGLE or step == steps - 1:
            moved, turned = 0.0, 0.0
            still_room = room_at(scene, x_next, y_next, yaw_next)
        passing_room = room_beside_movers(scene, x_next, y_next, (step + 1) * dt)
        if min(still_room, passing_room) < least_room:
            if still_room < least_room and (step - 1) * dt < seconds_to_stop:
                return np.inf, poses, speeds
            cost += (1.0 - step / steps) * (1.0 + weights.delay * steps * dt * to_go)
            poses[step + 1 :] = poses[step]
            break
        x, y, yaw = x_next, y_next, yaw_next
        poses[step + 1] = x, y, yaw
        speeds[step] = v, omega
        to_go = value_at(scene.to_go, scene, x, y)
        cost = _with_step(cost, v, omega, still_room, passing_room, to_go, limits, weights)
    return cost + to_go + weights.heading * _slope(scene, x, y, yaw, to_go), poses, speeds


@numba.njit(cache=True)
def _reached(v, omega, wanted, room, limits):
    """The speeds that a robot with so much room has after a period in which it is asked for others."""
    v = _towards(v, wanted[0], limits.acceleration * limits.period)
    v = _speed_in(v, room, limits)
    omega = _towards(omega, wanted[1], limits.turn_acceleration * limits.period)
    return v, min(max(omega, -limits.highest_omega), limits.highest_omega)


@numba.njit(cache=True)
def _moved(x, y, yaw, v, omega, dt):
    heading = yaw + 0.5 * omega * dt
    return x + v * dt * math.cos(heading), y + v * dt * math.sin(heading), yaw + omega * dt


@numba.njit(cache=True)
def _with_step(cost, v, omega, still_room, passing_room, to_go, limits, weights):
    """The cost with that of one period: nearness to what stays and to what moves, delay, turning, backing."""
    dt = limits.period
    nearness = _nearness(still_room, weights)
    cost += weights.obstacle * nearness * nearness * (abs(v) + CREEPING) * dt
    # Standing still makes nobody pass at a greater distance.
    nearness = _nearness(passing_room, weights)
    cost += weights.obstacle * nearness * nearness * limits.highest_v * dt
    return cost + dt * (weights.delay * to_go + weights.turn * omega * omega - weights.backward * min(v, 0.0))


@numba.njit(cache=True)
def _slope(scene, x, y, yaw, to_go):
    """How much the cost to go rises ahead of the robot: -1 if it faces the goal, 1 if it faces away."""
    ahead = value_at(scene.to_go, scene, x + NOSE * math.cos(yaw), y + NOSE * math.sin(yaw))
    return min(max((ahead - to_go) / NOSE, -1.0), 1.0)


@numba.njit(cache=True)
def _nearness(room, weights):
    """1 in touch, 0 from the safe distance on."""
    return 1.0 - max(room, 0.0) / weights.safe_distance if room < weights.safe_distance else 0.0


@numba.njit(cache=True)
def _towards(value, wanted, change):
    return min(max(wanted, value - change), value + change)


@numba.njit(cache=True)
def _speed_in(v, room, limits):
    """The speed cut to the limits and to what ``room`` metres of clearance allow."""
    highest = limits.highest_v
    if limits.approach_time > 0.0:
        highest = min(highest, max(limits.creep_v, room / limits.approach_time))
    return min(max(v, limits.lowest_v, -highest), highest)
