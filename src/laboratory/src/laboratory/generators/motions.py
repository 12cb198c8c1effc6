"""Motions of the cylinders of generated worlds: each is a family of trajectories of another kind.

Families are kept apart, so that a planner can be tuned on some and judged on the others. Positions are in a
square area of side 2 * HALF around the origin, which the robot crosses along y = 0 towards -x.
"""

import math
from typing import Callable, Dict, List, NamedTuple, Tuple

import numpy as np

# Half the side of the area, and the radius of a cylinder [m].
HALF, RADIUS = 10.0, 0.5
# Of a polynomial: columns at which it is sampled; step [m/s] and standard deviation of the segments' speeds.
COLUMNS, SPEED_STEP, SPEED_SIGMA = 10, 0.1, (0.01, 0.2)
# Pauses of stop-and-go, their number in each direction, and their length [s].
PAUSES, PAUSE_SECONDS = (1, 3), (0.5, 3.0)
# Members of a group, and the distance between neighbours [m].
GROUP_SIZES, GROUP_SPACING = (2, 4), 1.2
# Radii of circles [m], and chords of one.
CIRCLE_RADII, CHORDS = (1.0, 4.5), 36
# Of those that share the robot's route: lateral offset, amplitude and wavelength of weaving [m].
OFFSET, WEAVE, WAVELENGTH = 3.0, (0.0, 1.5), (5.0, 10.0)
# Walls with doorways beside the route: their distance from it, width of a doorway, and the walls' ends [m].
WALL_OFFSET, DOORWAY, WALL_END = 3.0, 1.8, 8.0


class Keyframes(NamedTuple):
    """Times (N,) from 0 [s] and positions (N, 2) [m] of a trajectory that is repeated after its last time."""

    times: np.ndarray
    points_xy: np.ndarray


class Course(NamedTuple):
    """Trajectories, and rows of the left and the right end and the y of walls parallel to the route [m]."""

    trajectories: List[Keyframes]
    walls: List[Tuple[float, float, float]] = []


# Returns a number of trajectories with speeds from a lowest to a highest one [m/s].
Motion = Callable[[int, Tuple[float, float], np.random.Generator], Course]


def polynomials(
    count: int,
    speeds: Tuple[float, float],
    rng: np.random.Generator,
    orders: Tuple[int, int] = (1, 6),
) -> Course:
    """Fits of polynomials y(x), from border to border, as DynaBARN's.

    The facts of its published generator (Nair et al., 2022): a polynomial is fitted to one more random points
    with integer coordinates than its order. Its samples in the area, these points and the points where it
    crosses the border are visited in the order of x or backwards, the first and the last on the border.
    Where two of the random points have one x, the fit misses them and the trajectory zigzags. The speed
    changes in steps of 0.1 m/s from segment to segment. After its end a trajectory starts again at its first
    point: a cylinder vanishes at one border and appears at another.

    Args:
        count: Number of trajectories.
        speeds: Lowest and highest speed [m/s].
        rng: Random number generator.
        orders: Lowest and highest order of the polynomials.
    """
    return Course([_polynomial(speeds, orders, rng) for _ in range(count)])


def _polynomial(speeds: Tuple[float, float], orders: Tuple[int, int], rng: np.random.Generator) -> Keyframes:
    points_xy = _points_of_polynomial(int(rng.integers(*orders, endpoint=True)), rng)
    steps = np.arange(speeds[0], speeds[1] + 1e-6, SPEED_STEP)
    mean, sigma = rng.uniform(*speeds), rng.uniform(*SPEED_SIGMA)
    odds = np.exp(-0.5 * ((steps - mean) / max(sigma, 0.3 * SPEED_STEP)) ** 2)
    return timed(points_xy, rng.choice(steps, len(points_xy) - 1, p=odds / odds.sum()))


def _points_of_polynomial(order: int, rng: np.random.Generator) -> np.ndarray:
    """Points (N, 2) of a trajectory from border to border."""
    x, y = rng.integers(-int(HALF), int(HALF), (2, order + 1), endpoint=True).astype(float)
    fit, _ = np.polynomial.Polynomial.fit(x, y, order, domain=(-HALF, HALF), full=True)
    columns = np.linspace(-HALF, HALF, COLUMNS)
    border_xy = []
    for side in (-HALF, HALF):
        roots = (fit - side).roots()
        if not np.iscomplex(roots).any():
            border_xy += [(root, side) for root in roots.real]
    border_xy += [(columns[0], fit(columns[0])), (columns[-1], fit(columns[-1]))]
    border_xy = sorted(point for point in border_xy if max(map(abs, point)) <= HALF)
    while len(border_xy) < 2:
        border_xy.append(tuple(rng.permutation([rng.choice([-HALF, HALF]), rng.uniform(-HALF, HALF)])))
    middle_xy = np.concatenate((np.column_stack((x, y)), np.column_stack((columns, fit(columns)))))
    middle_xy = middle_xy[(np.abs(middle_xy) < HALF).all(axis=1)]
    middle_xy = middle_xy[np.argsort(middle_xy[:, 0], kind="stable")]
    points_xy = np.concatenate(([border_xy[0]], middle_xy, [border_xy[-1]]))
    return points_xy[::-1] if rng.random() < 0.5 else points_xy


def stop_and_go(count: int, speeds: Tuple[float, float], rng: np.random.Generator) -> Course:
    """Straight across the area and back, with pauses."""
    return Course([_stop_and_go(rng.uniform(*speeds), rng) for _ in range(count)])


def _stop_and_go(speed: float, rng: np.random.Generator) -> Keyframes:
    start_xy, end_xy = crossing(rng)
    shares, waits = [0.0], [0.0]
    for far in (0.0, 1.0):
        stops = rng.uniform(0.0, 1.0, int(rng.integers(*PAUSES, endpoint=True)))
        shares += [*far + np.sort(stops), far + 1.0]
        waits += [*rng.uniform(*PAUSE_SECONDS, len(stops)), 0.0]
    driven = np.repeat(shares, 2)
    seconds = np.diff(driven) * float(np.linalg.norm(end_xy - start_xy)) / speed
    seconds[::2] = waits
    times, back = np.concatenate(([0.0], seconds.cumsum())), 1.0 - np.abs(driven - 1.0)
    return from_phase(_increasing(times, start_xy + back[:, None] * (end_xy - start_xy)), rng.random())


def groups(count: int, speeds: Tuple[float, float], rng: np.random.Generator) -> Course:
    """Groups, abreast or in file, straight across the area and back."""
    trajectories: List[Keyframes] = []
    while len(trajectories) < count:
        start_xy, end_xy = crossing(rng)
        along = (end_xy - start_xy) / np.linalg.norm(end_xy - start_xy)
        side = along if rng.random() < 0.5 else np.array([-along[1], along[0]])
        speed, phase = rng.uniform(*speeds), rng.random()
        size = int(rng.integers(*GROUP_SIZES, endpoint=True))
        for place in np.arange(size)[: count - len(trajectories)] - 0.5 * (size - 1):
            points_xy = np.array([start_xy, end_xy, start_xy]) + GROUP_SPACING * place * side
            trajectories.append(from_phase(timed(points_xy, speed), phase))
    return Course(trajectories)


def circles(count: int, speeds: Tuple[float, float], rng: np.random.Generator) -> Course:
    """Circles of different radii, in both directions."""
    return Course([_circle(rng.uniform(*speeds), rng) for _ in range(count)])


def _circle(speed: float, rng: np.random.Generator) -> Keyframes:
    radius = rng.uniform(*CIRCLE_RADII)
    centre_xy = rng.uniform(-1.0, 1.0, 2) * (HALF - 2.0 * RADIUS - radius)
    angles = rng.choice([-1.0, 1.0]) * np.linspace(0.0, 2.0 * math.pi, CHORDS + 1)
    points_xy = centre_xy + radius * np.column_stack((np.cos(angles), np.sin(angles)))
    return from_phase(timed(points_xy, speed), rng.random())


def along_route(count: int, speeds: Tuple[float, float], rng: np.random.Generator) -> Course:
    """Along the robot's route and back, weaving: they meet the robot or come from behind."""
    return Course([_along_route(rng.uniform(*speeds), rng) for _ in range(count)])


def _along_route(speed: float, rng: np.random.Generator) -> Keyframes:
    x = np.linspace(-HALF + 2.0 * RADIUS, HALF - 2.0 * RADIUS, 40)
    phase, amplitude = rng.uniform(0.0, 2.0 * math.pi), rng.uniform(*WEAVE)
    y = rng.uniform(-OFFSET, OFFSET) + amplitude * np.sin(
        2.0 * math.pi * x / rng.uniform(*WAVELENGTH) + phase
    )
    there_xy = np.column_stack((x, y))
    return from_phase(timed(np.concatenate((there_xy, there_xy[-2::-1])), speed), rng.random())


def through_doors(count: int, speeds: Tuple[float, float], rng: np.random.Generator) -> Course:
    """Out of a doorway beside the robot's route, across it into one on the other side, and back."""
    doorways = np.array([-5.0, 0.0, 5.0]) + rng.uniform(-1.2, 1.2, (2, 3))
    walls = []
    for side, centres in zip((-1.0, 1.0), doorways):
        jambs = [centre + half for centre in centres for half in (-0.5 * DOORWAY, 0.5 * DOORWAY)]
        edges = [-WALL_END, *jambs, WALL_END]
        walls += [(left, right, side * WALL_OFFSET) for left, right in zip(edges[::2], edges[1::2])]
    return Course([_through_doors(doorways, rng.uniform(*speeds), rng) for _ in range(count)], walls)


def _through_doors(doorways: np.ndarray, speed: float, rng: np.random.Generator) -> Keyframes:
    x = [rng.choice(centres) for centres in doorways]
    depths = rng.uniform(WALL_OFFSET + 1.5, HALF - 2.0 * RADIUS, 2)
    threshold = WALL_OFFSET - RADIUS
    there_xy = np.array(
        [(x[0], -depths[0]), (x[0], -threshold), (x[1], threshold), (x[1], depths[1])][:: rng.choice([-1, 1])]
    )
    return from_phase(timed(np.concatenate((there_xy, there_xy[-2::-1])), speed), rng.random())


# Motions by their names in a scenario.
MOTIONS: Dict[str, Motion] = {
    "polynomials": polynomials,
    "stop_and_go": stop_and_go,
    "groups": groups,
    "circles": circles,
    "along_route": along_route,
    "through_doors": through_doors,
}


def crossing(rng: np.random.Generator) -> Tuple[np.ndarray, np.ndarray]:
    """Return random points (2,) on two opposite sides of the area [m]."""
    limit = HALF - 2.0 * RADIUS
    along, across = rng.uniform(-limit, limit, 2), np.array([-limit, limit])
    ends_xy = np.column_stack((along, across) if rng.random() < 0.7 else (across, along))
    return ends_xy[0], ends_xy[1]


def timed(points_xy: np.ndarray, speeds) -> Keyframes:
    """Return the trajectory through points.

    Args:
        points_xy: (N, 2) [m].
        speeds: Speed, or (N - 1,) speeds of the segments [m/s].
    """
    seconds = np.linalg.norm(np.diff(points_xy, axis=0), axis=1) / speeds
    return _increasing(np.concatenate(([0.0], seconds.cumsum())), points_xy)


def from_phase(keyframes: Keyframes, phase: float) -> Keyframes:
    """Return the same closed trajectory, started at a share of its period.

    Args:
        keyframes: Trajectory whose last point is its first.
        phase: Share of the period, 0 to 1.
    """
    period = float(keyframes.times[-1])
    start = phase * period
    ahead = np.sort((keyframes.times[:-1] - start) % period)
    times = np.concatenate(([0.0], ahead, [period]))
    at = (start + times) % period
    points_xy = np.column_stack([np.interp(at, keyframes.times, xy) for xy in keyframes.points_xy.T])
    return _increasing(times, points_xy)


def _increasing(times: np.ndarray, points_xy: np.ndarray) -> Keyframes:
    """The trajectory without points that are reached at the same time as the one before."""
    is_later = np.concatenate(([True], np.diff(times) > 1e-6))
    return Keyframes(times[is_later], points_xy[is_later])
