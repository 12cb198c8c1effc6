"""Correlative scan matching: the best pose of a whole window, found coarse to fine.

E. Olson, "Real-time correlative scan matching", ICRA 2009: a coarse grid that holds maxima bounds from above
what any pose inside a coarse cell can score, so that only promising cells are searched finely. With a grid
for each halving of the cell this is the branch and bound of W. Hess et al., "Real-time loop closure in 2D
LIDAR SLAM", ICRA 2016.
"""

import math
from dataclasses import dataclass
from typing import Optional, Sequence, Tuple

import numba
import numpy as np

from planar import Pose2, wrap
from slam_lite.matching.local_map import OPPOSED, LocalMap, are_far, cell_of, turned_cosine
from slam_lite.surface import Surface


@dataclass(frozen=True)
class Window:
    """Poses to search: ``distance`` metres to each side in x and y, ``angle`` radians to each side."""

    distance: float
    angle: float


@dataclass(frozen=True)
class Peak:
    """The best pose of a window and its ``score``, the mean likelihood, 0 to 1, of the surface's points.

    ``is_unique``: no pose elsewhere in the window scores nearly as well, unless ``slide``, a unit vector (2,)
    along the map's axes or zeros, says along which line there are such poses, as in a smooth corridor.
    """

    base_pose: Pose2
    score: float
    is_unique: bool
    slide: np.ndarray


def search_near(
    surface: Surface,
    local_map: LocalMap,
    guess: Pose2,
    window: Window,
    variance: np.ndarray,
    new_share: float = 0.0,
) -> Pose2:
    """The best pose of a small window, in steps of two cells.

    ``variance``: (3,) of the guess, m^2, m^2, rad^2. To overrule it takes a share of the scan: somebody who
    walks ahead of the robot is but a few beams, wheels that slip are seen by all. ``new_share``: the share
    that nothing in the map can fit and that is likely to fit something else when it is elsewhere.
    """
    best = _search_near(
        local_map.layers,
        surface.points_xy,
        local_map.to_grid(guess),
        max(1, round(window.distance / (2.0 * local_map.resolution))),
        max(1, round(window.angle / _NEAR_ANGLE_STEP)),
        (2.0 * local_map.resolution) ** 2 / variance[0],
        _NEAR_ANGLE_STEP**2 / variance[2],
        max(_OVERRULING_SHARE, _OVERRULING_POINTS / max(len(surface), 1)) + new_share,
    )
    return local_map.from_grid(best)


_NEAR_ANGLE_STEP = 0.02
# The share of a scan that overrules the guess, how many points at least (who walks beside the robot may be
# all that it sees), and the chi-square at which half of that is needed.
_OVERRULING_SHARE, _OVERRULING_POINTS, _HALF_CHI_SQUARE = 0.15, 12.0, 9.0


def scores(
    surface: Surface, local_map: LocalMap, poses: Sequence[Pose2], is_sided: bool = False
) -> np.ndarray:
    """Mean likelihood (N,), 0 to 1, of the surface's points at each pose of the base.

    If ``is_sided``, a point that lies on the other side of a wall, as near as that may be, is on nothing.
    """
    in_grid = np.array([local_map.to_grid(pose) for pose in poses])
    return _scores(local_map.layers, surface.points_xy, surface.normals_xy, in_grid, is_sided)


@numba.njit(cache=True, nogil=True)
def _scores(layers, points, normals, poses, is_sided):
    found = np.empty(len(poses))
    for i in range(len(poses)):
        total, c, s = 0, math.cos(poses[i, 2]), math.sin(poses[i, 2])
        for p in range(len(points)):
            x, y = (
                poses[i, 0] + c * points[p, 0] - s * points[p, 1],
                poses[i, 1] + s * points[p, 0] + c * points[p, 1],
            )
            number, row, col = cell_of(layers, x, y)
            if number >= 0 and not (is_sided and _is_opposed(layers[number], row, col, normals[p], c, s)):
                total += layers[number][1][row, col]
        found[i] = total / (255.0 * len(points))
    return found


@numba.njit(cache=True, nogil=True)
def _is_opposed(layer, row, col, normal, c, s):
    """Whether the map's nearest point is on the other side of a wall from one of a ``normal``, turned."""
    nearest, _, _, map_normals, _, _ = layer
    i = nearest[row, col]
    return i >= 0 and turned_cosine(normal, map_normals[i], c, s) < OPPOSED


@numba.njit(cache=True, nogil=True)
def _search_near(layers, points, guess, steps, angle_steps, step_chi, angle_chi, share):
    (_, likelihood, _, _, resolution, _), (_, beyond, _, _, coarse, shift) = layers
    rows, cols = likelihood.shape
    is_far = are_far(layers, points, guess)
    near, far = points[~is_far], points[is_far]
    n = len(near)
    best_score, best = -np.inf, guess.copy()
    col, row = np.empty(n, dtype=np.int64), np.empty(n, dtype=np.int64)
    for k in range(-angle_steps, angle_steps + 1):
        yaw = guess[2] + k * _NEAR_ANGLE_STEP
        _project(near, guess[0], guess[1], yaw, resolution, col, row)
        for j in range(-steps, steps + 1):
            for i in range(-steps, steps + 1):
                x, y = guess[0] + 2 * i * resolution, guess[1] + 2 * j * resolution
                total = _sum_at(beyond, far, x + shift[0], y + shift[1], yaw, coarse)
                for p in range(n):
                    q, r = col[p] + 2 * i, row[p] + 2 * j
                    if 0 <= q < cols and 0 <= r < rows:
                        total += likelihood[r, q]
                chi = step_chi * (i * i + j * j) + angle_chi * k * k
                penalty = share * chi / (chi + _HALF_CHI_SQUARE)
                score = total / (255.0 * max(len(points), 1)) - penalty
                if score > best_score:
                    best_score = score
                    best[0], best[1], best[2] = x, y, yaw
    return best


@numba.njit(cache=True, nogil=True)
def _sum_at(grid, points, x, y, yaw, resolution):
    """Sum of a grid's cells that the points lie in, seen from a pose, metres from its corner."""
    total = 0
    c, s = math.cos(yaw), math.sin(yaw)
    for p in range(len(points)):
        q = int(math.floor((x + c * points[p, 0] - s * points[p, 1]) / resolution))
        r = int(math.floor((y + s * points[p, 0] + c * points[p, 1]) / resolution))
        if 0 <= q < grid.shape[1] and 0 <= r < grid.shape[0]:
            total += grid[r, q]
    return total


def search_far(
    surface: Surface, local_map: LocalMap, guess: Pose2, window: Window, min_score: float, apart: float
) -> Optional[Peak]:
    """The best pose of a wide window, to one cell and about one cell's width at the far points.

    None if no pose scores ``min_score``. Poses less than ``apart`` metres and 0.5 rad away are no rivals.
    """
    if len(surface) == 0:
        return None
    resolution = local_map.resolution
    radius = float(np.sqrt(np.mean(np.sum(surface.points_xy.astype(np.float64) ** 2, axis=1))))
    angle_step = 1.5 * resolution / max(radius, 1.0)
    angle_steps = math.ceil(window.angle / angle_step)
    cells = math.ceil(window.distance / resolution)
    start = local_map.to_grid(guess)
    likelihood, corner = _cropped(local_map.likelihood)
    start[:2] -= corner * resolution
    maxima = _maxima(likelihood)
    cols, rows = _rotated_cells(resolution, surface.points_xy, start, angle_step, angle_steps)
    bounds = _coarse_bounds(maxima[-1], cols, rows, cells)
    promising = np.flatnonzero(bounds > min_score)
    order = promising[np.argsort(-bounds.ravel()[promising], kind="stable")]
    search = (maxima, bounds, order, cols, rows, cells)
    best, score = _climb(*search, min_score, 2.0, np.zeros(3, dtype=np.int64), (0.0, 0, 0), np.zeros(2))
    if score <= min_score:
        return None
    enough = _RIVAL_SHARE * score
    apart_angles = math.ceil(0.5 / angle_step)
    is_far = apart / resolution, apart_angles, round(2.0 * math.pi / angle_step)
    slide = np.zeros(2)
    rival, rival_score = _climb(*search, enough, enough, best, is_far, slide)
    is_unique = rival_score <= enough
    if not is_unique and abs(rival[2] - best[2]) < apart_angles:
        slide = (rival - best)[:2] / np.hypot(*(rival - best)[:2])
        _, rival_score = _climb(*search, enough, enough, best, is_far, slide)
        is_unique = rival_score <= enough
    x, y = start[:2] + (best[:2] + corner) * resolution
    yaw = wrap(start[2] + (best[2] - angle_steps) * angle_step)
    base_pose = local_map.from_grid(np.array([x, y, yaw]))
    return Peak(base_pose, score, is_unique, slide)


# A pose elsewhere that scores this share of the best one makes it doubtful.
_RIVAL_SHARE = 0.9
_LEVELS = 4
_COARSE = 2**_LEVELS


@numba.njit(cache=True, nogil=True)
def _project(points, x, y, yaw, resolution, col, row):
    c, s = math.cos(yaw), math.sin(yaw)
    for p in range(len(points)):
        col[p] = int(math.floor((x + c * points[p, 0] - s * points[p, 1]) / resolution))
        row[p] = int(math.floor((y + s * points[p, 0] + c * points[p, 1]) / resolution))


def _cropped(likelihood: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The part of a grid that holds something, with an empty border, and its first (col, row)."""
    bounds = [np.flatnonzero(likelihood.any(axis=axis)) for axis in (0, 1)]
    if len(bounds[0]) == 0:
        return likelihood[:1, :1], np.zeros(2)
    (left, right), (low, high) = ((filled[0] - _COARSE, filled[-1] + 1 + _COARSE) for filled in bounds)
    return likelihood[low:high, left:right], np.array([left, low])


def _maxima(likelihood: np.ndarray) -> np.ndarray:
    """(levels + 1, rows, cols): at level k the maximum of the 2^k x 2^k cells from each cell on."""
    maxima = np.empty((_LEVELS + 1, *likelihood.shape), dtype=np.uint8)
    maxima[0] = likelihood
    for level in range(_LEVELS):
        width = 2**level
        wide = maxima[level].copy()
        np.maximum(wide[:, :-width], maxima[level][:, width:], out=wide[:, :-width])
        maxima[level + 1] = wide
        np.maximum(wide[:-width], wide[width:], out=maxima[level + 1][:-width])
    return maxima


@numba.njit(cache=True, nogil=True)
def _rotated_cells(resolution, points, start, angle_step, angle_steps):
    """Columns and rows (angles, N) of the points' cells for each angle of the window."""
    cols = np.empty((2 * angle_steps + 1, len(points)), dtype=np.int64)
    rows = np.empty_like(cols)
    for k in range(len(cols)):
        yaw = start[2] + (k - angle_steps) * angle_step
        _project(points, start[0], start[1], yaw, resolution, cols[k], rows[k])
    return cols, rows


@numba.njit(cache=True, nogil=True)
def _score(grid, cols, rows, du, dv):
    total = 0
    for p in range(len(cols)):
        col, row = cols[p] + du, rows[p] + dv
        if 0 <= col < grid.shape[1] and 0 <= row < grid.shape[0]:
            total += grid[row, col]
    return total / (255.0 * len(cols))


def _coarse_bounds(coarse: np.ndarray, cols: np.ndarray, rows: np.ndarray, cells: int) -> np.ndarray:
    """Upper bounds (angles, side, side) of the score of shifts by ``-cells`` and coarse steps from there."""
    if 2 * cells // _COARSE < _MANY_SHIFTS:
        return _bounds_of_few(coarse, cols, rows, cells)
    return _bounds_of_many(_phases(coarse), cols, rows, cells)


# From so many coarse shifts on it pays to lay their cells side by side.
_MANY_SHIFTS = 5


def _phases(coarse: np.ndarray) -> np.ndarray:
    """The cells one coarse step apart side by side, (step, step, rows, cols).

    Entry [r, c, j, i] is the coarse grid's [r + j * step, c + i * step].
    """
    rows, cols = (-(-side // _COARSE) for side in coarse.shape)
    padded = np.zeros((rows * _COARSE, cols * _COARSE), dtype=np.uint8)
    padded[: coarse.shape[0], : coarse.shape[1]] = coarse
    return np.ascontiguousarray(padded.reshape(rows, _COARSE, cols, _COARSE).transpose(1, 3, 0, 2))


@numba.njit(cache=True, nogil=True)
def _bounds_of_few(coarse, cols, rows, cells):
    side = 2 * cells // _COARSE + 1
    bounds = np.empty((len(cols), side, side), dtype=np.float32)
    for k in range(len(cols)):
        for j in range(side):
            for i in range(side):
                bounds[k, j, i] = _score(coarse, cols[k], rows[k], i * _COARSE - cells, j * _COARSE - cells)
    return bounds


@numba.njit(cache=True, nogil=True)
def _bounds_of_many(phases, cols, rows, cells):
    side = 2 * cells // _COARSE + 1
    high, wide = phases.shape[2:]
    bounds = np.empty((len(cols), side, side), dtype=np.float32)
    totals = np.empty((side, side), dtype=np.uint32)
    for k in range(len(cols)):
        totals[:] = 0
        for p in range(cols.shape[1]):
            row, col = rows[k, p] - cells, cols[k, p] - cells
            plane = phases[row % _COARSE, col % _COARSE]
            row, col = row // _COARSE, col // _COARSE
            first = min(max(0, -col), side)
            end = max(min(side, wide - col), first)
            for j in range(max(0, -row), min(side, high - row)):
                line, total = plane[row + j, col + first : col + end], totals[j, first:end]
                for i in range(len(total)):
                    total[i] += line[i]
        for j in range(side):
            for i in range(side):
                bounds[k, j, i] = totals[j, i] / (255.0 * cols.shape[1])
    return bounds


@numba.njit(cache=True, nogil=True)
def _climb(maxima, bounds, order, cols, rows, cells, min_score, enough, excluded, is_far, slide):
    """Best (col shift, row shift, angle index) above ``min_score``, and its score, by branch and bound.

    Poses near the ``excluded`` one, or near the line through it along ``slide``, do not count. Ends early
    when a score exceeds ``enough``.
    """
    side = bounds.shape[1]
    best, best_score = np.zeros(3, dtype=np.int64), min_score
    stack = np.empty((4 * _LEVELS, 3), dtype=np.int64)
    stack_bounds = np.empty(4 * _LEVELS)
    for flat in order:
        k, j, i = flat // (side * side), flat // side % side, flat % side
        if bounds[k, j, i] <= best_score or best_score > enough:
            break
        stack[0] = _LEVELS, i * _COARSE - cells, j * _COARSE - cells
        stack_bounds[0] = bounds[k, j, i]
        depth = 1
        while depth > 0:
            depth -= 1
            if stack_bounds[depth] <= best_score:
                continue
            level, u, v = stack[depth]
            if level > 0:
                _split(maxima[level - 1], cols[k], rows[k], stack, stack_bounds, depth)
                depth += 4
                continue
            is_inside = abs(u) <= cells and abs(v) <= cells
            if is_inside and _is_apart(u - excluded[0], v - excluded[1], k - excluded[2], is_far, slide):
                best_score = stack_bounds[depth]
                best[0], best[1], best[2] = u, v, k
    return best, best_score


@numba.njit(cache=True, nogil=True)
def _split(finer, cols, rows, stack, stack_bounds, first):
    """Puts the four quarters of the cell at ``first`` on top of the stack in its place, the best one last."""
    level, u, v = stack[first]
    half = 2 ** (level - 1)
    for quarter in range(4):
        shift_u, shift_v = u + half * (quarter % 2), v + half * (quarter // 2)
        bound = _score(finer, cols, rows, shift_u, shift_v)
        at = first + quarter
        while at > first and stack_bounds[at - 1] > bound:
            stack[at], stack_bounds[at] = stack[at - 1], stack_bounds[at - 1]
            at -= 1
        stack[at] = level - 1, shift_u, shift_v
        stack_bounds[at] = bound


@numba.njit(cache=True, nogil=True)
def _is_apart(du, dv, dk, is_far, slide):
    """Whether poses that differ by (du, dv, dk) are far from each other, also across the direction ``slide``.

    ``is_far``: from how many cells or angle steps on, and how many of these make a full turn.
    """
    cells, angles, full_turn = is_far
    along = slide[0] * du + slide[1] * dv
    turn = min(abs(dk), full_turn - abs(dk))
    return du * du + dv * dv - along * along >= cells * cells or turn >= angles
