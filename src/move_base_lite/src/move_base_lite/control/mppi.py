"""Model predictive path integral control (Williams et al., 2017) on a field of the cost to go."""

import math
from typing import NamedTuple, Optional

import numba
import numpy as np

from move_base_lite.control.exploration import Exploration
from move_base_lite.control.settings import MppiSettings
from move_base_lite.control.trajectory import Trajectory
from move_base_lite.costmap import LETHAL, LayeredCostmap
from move_base_lite.errors import ControlError
from move_base_lite.planning.wavefront import NEUTRAL, cost_to_go
from planar import Pose2, Twist2
from planar.geometry.distance_field import distance_field

# Points in time at which the speeds of a sample are drawn; between them they change evenly.
KNOTS = 5
# Radians of a turn, and metres, after which the footprint is checked anew.
CHECKED_ANGLE = 0.1
CHECKED_DISTANCE = 0.05
# Metres ahead at which the slope of the cost to go is felt.
NOSE = 0.3
# Metres around what moves within which obstacles are taken for it.
AROUND_MOVER = 0.1
# m/s that a robot counts as at least when it lingers near an obstacle.
CREEPING = 0.1
FAR = 1e3


class PathIntegral:
    """Drives the mean of many random ways, weighted by what each costs, and starts the next from it.

    What a way costs is what is left to drive at its end, through free cells and shy of obstacles, in metres,
    with penalties for nearness, turning and driving backwards. A way that touches something ends there; if
    the robot could not stop before, it does not count. What moves is expected where it will be by then.
    The random deviations are drawn once, from the seed. They are not shown as an ``exploration``.
    """

    exploration: Optional[Exploration] = None

    def __init__(self, settings: MppiSettings, period: float):
        self._settings = settings
        self._period = period
        steps = max(KNOTS, round(settings.horizon / period))
        rng = np.random.default_rng(settings.seed)
        self._noise = _smooth_noise(rng, settings, steps)
        self._fan = _fan(settings, steps)
        self._mean = np.zeros((steps, 2))
        self._weights = _Weights(
            safe_distance=settings.safe_distance,
            obstacle=settings.obstacle_weight,
            turn=settings.turn_weight,
            backward=settings.backward_weight,
            heading=settings.heading_weight,
            delay=settings.delay_weight,
        )

    def reset(self) -> None:
        """Forgets how it has been driving."""
        self._mean[:] = 0.0

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
        """The velocity for the next period, within the ``highest`` speeds, and where it may lead.

        Raises ControlError if every way tried hits something.
        """
        settings = self._settings
        scene = _Scene(
            clearance=distance_field(_standing(costmap, movers), costmap.window.resolution, FAR),
            to_go=self._cost_to_go(costmap, plan_xy),
            origin_x=costmap.window.origin_x,
            origin_y=costmap.window.origin_y,
            resolution=costmap.window.resolution,
            outline_xy=costmap.outline_xy,
            inscribed_radius=costmap.footprint.inscribed_radius,
            circumscribed_radius=costmap.footprint.circumscribed_radius,
            movers=movers,
        )
        start = np.array([*base_pose.as_array(), twist.v, twist.omega])
        problem = (start, scene, self._limits(highest), self._weights)
        samples = np.concatenate((self._mean + self._noise, self._fan))
        costs = _costs_of(samples, *problem)
        best = int(np.argmin(costs))
        if not math.isfinite(costs[best]):
            self.reset()
            raise ControlError("every way tried leads into an obstacle")
        weights = np.exp((costs[best] - costs) / settings.temperature)
        mean = _mean_of(samples, weights / weights.sum())
        cost, poses, speeds = _drive(mean, *problem)
        if not cost <= costs[best] + settings.temperature:
            mean = samples[best]
            cost, poses, speeds = _drive(mean, *problem)
        self._mean = np.concatenate((mean[1:], mean[-1:]))
        v, omega = map(float, speeds[0])
        return Trajectory(Twist2(v, omega), poses, float(cost))

    def _limits(self, highest: Twist2) -> "_Limits":
        settings = self._settings
        return _Limits(
            period=self._period,
            lowest_v=settings.min_vel_x,
            highest_v=highest.v,
            highest_omega=highest.omega,
            acceleration=settings.acc_lim_x,
            turn_acceleration=settings.acc_lim_theta,
            approach_time=settings.approach_time,
            creep_v=settings.creep_vel_x,
        )

    def _cost_to_go(self, costmap: LayeredCostmap, plan_xy: np.ndarray) -> np.ndarray:
        """Metres, float32 (rows, cols), to the plan's last point in the window that is free."""
        window = costmap.window
        cells = np.floor((plan_xy - (window.origin_x, window.origin_y)) / window.resolution)
        field = cost_to_go(costmap.costs, cells[:, ::-1].astype(np.int64))
        if field is None:
            raise ControlError("all of the plan in sight is blocked")
        return field * np.float32(window.resolution / NEUTRAL)


def _standing(costmap: LayeredCostmap, movers: np.ndarray) -> np.ndarray:
    """Which cells (rows, cols) are obstacles that stay: those that movers are seen in will have gone."""
    obstacles, window = costmap.costs >= LETHAL, costmap.window
    for x, y, _, _, radius in movers:
        bounds = window.bounds_around(x, y, radius + AROUND_MOVER)
        block = obstacles[slice(*bounds[:2]), slice(*bounds[2:])]
        rows, cols = np.nonzero(block)
        apart_x = window.origin_x + (bounds[2] + cols + 0.5) * window.resolution - x
        apart_y = window.origin_y + (bounds[0] + rows + 0.5) * window.resolution - y
        is_its_own = np.hypot(apart_x, apart_y) < radius + AROUND_MOVER
        block[rows[is_its_own], cols[is_its_own]] = False
    return obstacles


def _smooth_noise(rng: np.random.Generator, settings: MppiSettings, steps: int) -> np.ndarray:
    """Deviations (samples, steps, 2) of speed and turn rate; the first is none."""
    knots = rng.standard_normal((settings.samples, KNOTS, 2))
    knots *= (settings.noise_vel_x, settings.noise_vel_theta)
    knots[0] = 0.0
    at = np.linspace(0.0, KNOTS - 1.0, steps)
    before = np.minimum(at.astype(int), KNOTS - 2)
    share = (at - before)[None, :, None]
    return (1.0 - share) * knots[:, before] + share * knots[:, before + 1]


def _fan(settings: MppiSettings, steps: int) -> np.ndarray:
    """Ways (N, steps, 2) that a stuck mean would not come upon: arcs at some speeds, ahead and back."""
    speeds = [settings.max_vel_x, 0.5 * settings.max_vel_x, settings.creep_vel_x, 0.0, settings.min_vel_x]
    rates = np.linspace(-settings.max_vel_theta, settings.max_vel_theta, 11)
    arcs = np.array([(v, omega) for v in speeds for omega in rates])
    return np.repeat(arcs[:, None, :], steps, axis=1)


class _Scene(NamedTuple):
    """What there is around the robot: fields (rows, cols) in metres, and the outline it fills itself."""

    clearance: np.ndarray
    to_go: np.ndarray
    origin_x: float
    origin_y: float
    resolution: float
    outline_xy: np.ndarray
    inscribed_radius: float
    circumscribed_radius: float
    movers: np.ndarray


class _Limits(NamedTuple):
    period: float
    lowest_v: float
    highest_v: float
    highest_omega: float
    acceleration: float
    turn_acceleration: float
    approach_time: float
    creep_v: float


class _Weights(NamedTuple):
    safe_distance: float
    obstacle: float
    turn: float
    backward: float
    heading: float
    delay: float


@numba.njit(cache=True)
def _costs_of(samples, start, scene, limits, weights):
    costs = np.empty(samples.shape[0])
    for i in range(samples.shape[0]):
        costs[i] = _drive(samples[i], start, scene, limits, weights)[0]
    return costs


@numba.njit(cache=True)
def _mean_of(samples, weights):
    """The weighted mean; a product of BLAS would take more than one core for a moment."""
    mean = np.zeros(samples.shape[1:])
    for i in range(samples.shape[0]):
        if weights[i] > 0.0:
            mean += weights[i] * samples[i]
    return mean


@numba.njit(cache=True)
def _drive(wanted, start, scene, limits, weights):
    """Cost, poses (N + 1, 3) and speeds (N, 2) of a robot that is asked for the speeds ``wanted`` (N, 2).

    The speeds are those it can reach, cut to what its clearance allows. The cost is inf if it hits what stays
    before it could have stopped. A robot in touch may move as long as it never touches at more points.
    """
    steps = wanted.shape[0]
    poses, speeds = np.empty((steps + 1, 3)), np.zeros((steps, 2))
    dt = limits.period
    x, y, yaw, v, omega = start
    poses[0] = x, y, yaw
    still_room = _room(scene, x, y, yaw)
    least_room = min(scene.resolution, still_room, _room_beside_movers(scene, x, y, 0.0))
    seconds_to_stop = abs(v) / limits.acceleration
    cost, moved, turned = 0.0, 0.0, 0.0
    to_go = _at(scene.to_go, scene, x, y)
    for step in range(steps):
        v = _towards(v, wanted[step, 0], limits.acceleration * dt)
        v = _speed_in(v, still_room, limits)
        omega = _towards(omega, wanted[step, 1], limits.turn_acceleration * dt)
        omega = min(max(omega, -limits.highest_omega), limits.highest_omega)
        heading = yaw + 0.5 * omega * dt
        x_next, y_next = x + v * dt * math.cos(heading), y + v * dt * math.sin(heading)
        yaw_next = yaw + omega * dt
        moved, turned = moved + abs(v) * dt, turned + abs(omega) * dt
        if moved > CHECKED_DISTANCE or turned > CHECKED_ANGLE or step == steps - 1:
            moved, turned = 0.0, 0.0
            still_room = _room(scene, x_next, y_next, yaw_next)
        passing_room = _room_beside_movers(scene, x_next, y_next, (step + 1) * dt)
        if min(still_room, passing_room) < least_room:
            if still_room < least_room and (step - 1) * dt < seconds_to_stop:
                return np.inf, poses, speeds
            cost += (1.0 - step / steps) * (1.0 + weights.delay * steps * dt * to_go)
            for rest in range(step, steps):
                poses[rest + 1] = x, y, yaw
            break
        x, y, yaw = x_next, y_next, yaw_next
        poses[step + 1] = x, y, yaw
        speeds[step] = v, omega
        nearness = _nearness(still_room, weights)
        cost += weights.obstacle * nearness * nearness * (abs(v) + CREEPING) * dt
        # Standing still makes nobody pass at a greater distance.
        nearness = _nearness(passing_room, weights)
        cost += weights.obstacle * nearness * nearness * limits.highest_v * dt
        to_go = _at(scene.to_go, scene, x, y)
        cost += dt * (weights.delay * to_go + weights.turn * omega * omega - weights.backward * min(v, 0.0))
    ahead = _at(scene.to_go, scene, x + NOSE * math.cos(yaw), y + NOSE * math.sin(yaw))
    slope = min(max((ahead - to_go) / NOSE, -1.0), 1.0)
    return cost + to_go + weights.heading * slope, poses, speeds


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


@numba.njit(cache=True)
def _room(scene, x, y, yaw):
    """Metres from the outline to the nearest obstacle, at least; if it touches, minus how many points do.

    All that is outside the window counts as an obstacle.
    """
    rows, cols = scene.clearance.shape
    base_col = (x - scene.origin_x) / scene.resolution
    base_row = (y - scene.origin_y) / scene.resolution
    row, col = math.floor(base_row), math.floor(base_col)
    touching, nearest = 0, FAR
    if row < 0 or row >= rows or col < 0 or col >= cols:
        touching = 1
    else:
        around = scene.clearance[row, col]
        if around > 2.0 * scene.circumscribed_radius:
            return around - scene.circumscribed_radius
        if around < scene.inscribed_radius:
            touching = 1
    c, s = math.cos(yaw) / scene.resolution, math.sin(yaw) / scene.resolution
    for i in range(scene.outline_xy.shape[0]):
        along, across = scene.outline_xy[i]
        row = math.floor(base_row + s * along + c * across)
        col = math.floor(base_col + c * along - s * across)
        if row < 0 or row >= rows or col < 0 or col >= cols or scene.clearance[row, col] == 0.0:
            touching += 1
        else:
            nearest = min(nearest, scene.clearance[row, col])
    return nearest if touching == 0 else -float(touching)


@numba.njit(cache=True)
def _room_beside_movers(scene, x, y, seconds):
    """Metres from the robot's circle to the nearest of what moves, so many seconds from now."""
    nearest = FAR
    for i in range(scene.movers.shape[0]):
        mover_x, mover_y, v_x, v_y, radius = scene.movers[i]
        apart = math.hypot(mover_x + seconds * v_x - x, mover_y + seconds * v_y - y)
        nearest = min(nearest, apart - radius - scene.circumscribed_radius)
    return nearest


@numba.njit(cache=True)
def _at(field, scene, x, y):
    """A field between the centres of its cells; FAR where it is not known."""
    rows, cols = field.shape
    u = (y - scene.origin_y) / scene.resolution - 0.5
    w = (x - scene.origin_x) / scene.resolution - 0.5
    row, col = int(math.floor(u)), int(math.floor(w))
    if row < 0 or row >= rows - 1 or col < 0 or col >= cols - 1:
        return FAR
    u, w = u - row, w - col
    total, weight = 0.0, 0.0
    for i in range(2):
        for j in range(2):
            value = field[row + i, col + j]
            if value < np.inf:
                share = (u if i else 1.0 - u) * (w if j else 1.0 - w)
                total += share * value
                weight += share
    return total / weight if weight > 0.0 else FAR
