"""Ways of driving followed ahead, and what they cost. Kernels."""

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


class Outset(NamedTuple):
    """What all ways have in common that start together: metres, seconds, periods.

    ``enough``: room above which more makes no difference; ``aside``: room beside what moves from which on it
    need not be told; with less than ``least_room`` and ``least_aside`` the robot touches something.
    """

    steps: int
    enough: float
    aside: float
    least_room: float
    least_aside: float
    seconds_to_stop: float


# Where a robot is on its way: pose and speeds, cosine and sine of its yaw, what the way has cost so far, how
# likely something that moves was touched, room around it (see room_at), metres to go.
MOTION = np.dtype([(name, float) for name in "x y yaw c s v omega cost risk room to_go".split()])

# Of what every period of every way needs: left to itself, the compiler calls it with some 50 arguments.
_in_place = numba.njit(cache=True, forceinline=True)


@numba.njit(cache=True)
def best_way(noise, mean, others, start, temperature, clearance, to_go, outline_xy, movers, numbers):
    """The mean of the ways tried, weighted by what each costs, or the best of them if that is better.

    Tried are ``mean`` (N, 2) with ``noise`` (M, N, 2) and ``others`` (L, N, 2), in this order.

    Returns the speeds asked for (N, 2), cost, poses and speeds (see drive); the cost is inf if all hit
    something. Takes arrays of a scene one by one, and all numbers in one: names take numba long to look at.
    """
    scene, limits, weights = _named(clearance, to_go, outline_xy, movers, numbers)
    ways, problem = (noise, mean, others), (scene, limits, weights)
    costs, average, total = costs_of(ways, start, problem), np.zeros(mean.shape), 0.0
    best = np.argmin(costs)
    lowest, poses, speeds = costs[best], np.empty((len(mean) + 1, 3)), np.empty(mean.shape)
    if lowest < np.inf:
        for i in range(len(costs)):
            weight = math.exp((lowest - costs[i]) / temperature)
            total += weight
            if weight > 0.0:
                _add(average, weight, i, ways)
        average /= total
        lowest = drive(average, start, problem, poses, speeds)
        if not lowest <= costs[best] + temperature:
            average[:] = 0.0
            _add(average, 1.0, best, ways)
            lowest = drive(average, start, problem, poses, speeds)
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


@_in_place
def _wanted(i, step, ways):
    """The speeds asked for in a step of the way number ``i`` of those that are tried."""
    noise, mean, others = ways
    if i < len(noise):
        return noise[i, step, 0] + mean[step, 0], noise[i, step, 1] + mean[step, 1]
    return others[i - len(noise), step, 0], others[i - len(noise), step, 1]


@numba.njit(cache=True)
def _add(average, weight, i, ways):
    for step in range(average.shape[0]):
        v, omega = _wanted(i, step, ways)
        average[step, 0] += weight * v
        average[step, 1] += weight * omega


@numba.njit(cache=True)
def costs_of(ways, start, problem):
    """What each of the ways costs, as ``drive`` tells it of one.

    They go on side by side, period by period: a processor is quicker at many that do not depend on each
    other than at one after the other.
    """
    count = len(ways[0]) + len(ways[2])
    motions = np.empty(count, MOTION)
    outset = _outset(motions, len(ways[1]), start, problem)
    costs, numbers = np.empty(count), np.arange(count)
    under_way = count
    for step in range(outset.steps):
        i = 0
        while i < under_way:
            if _goes_on(motions[i], step, _wanted(numbers[i], step, ways), outset, problem):
                i += 1
                continue
            costs[numbers[i]] = _cost_at_end(motions[i], problem)
            under_way -= 1
            motions[i], numbers[i] = motions[under_way], numbers[under_way]
    for i in range(under_way):
        costs[numbers[i]] = _cost_at_end(motions[i], problem)
    return costs


@numba.njit(cache=True)
def drive(wanted, start, problem, poses, speeds):
    """The cost of a robot that is asked for the speeds ``wanted`` (N, 2), in metres left to drive.

    Fills in the poses (N + 1, 3) and speeds (N, 2), those it can reach, cut to what its clearance allows; it
    is inf if it hits what stays before it could have stopped. In touch it may move if no more points touch.
    """
    motions = np.empty(1, MOTION)
    outset = _outset(motions, len(wanted), start, problem)
    motion, poses[0] = motions[0], start[:3]
    for step in range(outset.steps):
        if not _goes_on(motion, step, (wanted[step, 0], wanted[step, 1]), outset, problem):
            poses[step + 1 :], speeds[step:] = poses[step], 0.0
            break
        poses[step + 1] = motion.x, motion.y, motion.yaw
        speeds[step] = motion.v, motion.omega
    return _cost_at_end(motion, problem)


@numba.njit(cache=True)
def _outset(motions, steps, start, problem):
    """What ways of so many periods have in common; sets motions to the start."""
    scene, limits, weights = problem
    x, y, yaw, v, omega = start
    c, s, cell = math.cos(yaw), math.sin(yaw), 1.0 / scene.cells_per_metre
    enough = _exact_below(scene, limits, weights)
    aside = max(weights.mover_distance, cell + _doubt(steps * limits.period))
    room = room_at(scene, x, y, c, s, enough)
    least_aside = min(cell, room_beside_movers(scene, x, y, 0.0, aside))
    to_go = value_at(scene.to_go, scene, x, y)
    for motion in motions:
        motion.x, motion.y, motion.yaw, motion.c, motion.s = x, y, yaw, c, s
        motion.v, motion.omega, motion.cost, motion.risk = v, omega, 0.0, 0.0
        motion.room, motion.to_go = room, to_go
    return Outset(steps, enough, aside, min(cell, room), least_aside, abs(v) / limits.acceleration)


@_in_place
def _goes_on(motion, step, wanted, outset, problem):
    """Whether the robot gets through the period in which it is asked for such speeds; it is moved on then.

    If not it stays where it was, which costs the rest of the time; or all, if it could not have stopped.
    """
    scene, limits, weights = problem
    dt, seconds = limits.period, (step + 1) * limits.period
    v, omega = _reached(motion.v, motion.omega, wanted, motion.room, limits)
    turn = _turn(0.5 * omega * dt)
    ahead_c, ahead_s = _turned(motion.c, motion.s, turn)
    c, s = _turned(ahead_c, ahead_s, turn)
    x, y = motion.x + v * dt * ahead_c, motion.y + v * dt * ahead_s
    room = room_at(scene, x, y, c, s, outset.enough)
    passing_room = room_beside_movers(scene, x, y, seconds, outset.aside)
    left = 1.0 - step / outset.steps
    risk = max(motion.risk, _risk(passing_room - outset.least_aside, seconds))
    cost = motion.cost + left * weights.mover * (risk - motion.risk)
    if room < outset.least_room or risk == 1.0:
        if room < outset.least_room and (step - 1) * dt < outset.seconds_to_stop:
            cost = np.inf
        motion.cost = cost + left * (1.0 + weights.delay * outset.steps * dt * motion.to_go)
        return False
    to_go = value_at(scene.to_go, scene, x, y)
    motion.x, motion.y, motion.yaw, motion.c, motion.s = x, y, motion.yaw + omega * dt, c, s
    motion.v, motion.omega, motion.risk, motion.room, motion.to_go = v, omega, risk, room, to_go
    motion.cost = _with_step(cost, v, omega, room, passing_room, to_go, limits, weights)
    return True


@numba.njit(cache=True)
def _cost_at_end(motion, problem):
    scene, _, weights = problem
    ahead_of_goal = _slope(scene, motion.x, motion.y, motion.yaw, motion.to_go)
    return motion.cost + motion.to_go + weights.heading * ahead_of_goal


@numba.njit(cache=True)
def _exact_below(scene, limits, weights):
    """Metres of room above which more makes no difference, or a round robot surely touches nothing."""
    if scene.circumscribed_radius - scene.inscribed_radius < 1.0 / scene.cells_per_metre:
        return SURELY_FREE / scene.cells_per_metre
    return max(weights.safe_distance, limits.highest_v * limits.approach_time, 1.0 / scene.cells_per_metre)


@_in_place
def _reached(v, omega, wanted, room, limits):
    """The speeds that a robot with so much ``room`` has after a period in which it is asked for others."""
    allowed_v = _highest_speed_in(room, limits)
    v = _towards(v, wanted[0], limits.acceleration * limits.period)
    v = min(max(v, limits.lowest_v, -allowed_v), allowed_v)
    omega = _towards(omega, wanted[1], limits.turn_acceleration * limits.period)
    return v, min(max(omega, -limits.highest_omega), limits.highest_omega)


@_in_place
def _turn(angle):
    """Cosine and sine of an angle; of small ones by their series, to the last bits."""
    if abs(angle) > SMALL_ANGLE:
        return math.cos(angle), math.sin(angle)
    square = angle * angle
    c = 1.0 - square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)))
    return c, angle * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)))


@_in_place
def _turned(c, s, turn):
    """Cosine and sine of a heading turned by an angle that is told by the same of it."""
    by_c, by_s = turn
    return c * by_c - s * by_s, s * by_c + c * by_s


@_in_place
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


@_in_place
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
