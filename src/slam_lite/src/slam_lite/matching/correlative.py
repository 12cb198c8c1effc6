"""Correlative scan matching: finds the best pose of a whole search window.

E. Olson, "Real-time correlative scan matching", ICRA 2009: a coarse grid of maxima gives an upper bound of
the score of all poses inside a coarse cell, so that only promising cells are searched finely. With a grid for
each halving of the cell this is the branch and bound of W. Hess et al., "Real-time loop closure in 2D LIDAR
SLAM", ICRA 2016.
"""

import math
from dataclasses import dataclass
from typing import Optional, Sequence, Tuple

import numba
import numpy as np

from planar import Pose2, wrap
from slam_lite.matching.local_map import OPPOSED, LocalMap, are_far, cell_of, turned_cosine, unpacked
from slam_lite.point_cloud import PointCloud


@dataclass(frozen=True)
class SearchWindow:
    """Search window around a guess.

    Attributes:
        distance: Half the width in x and y [m].
        angle: Half the range of headings [rad].
    """

    distance: float
    angle: float


@dataclass(frozen=True)
class Peak:
    """Best pose of a search window.

    Attributes:
        base_pose: Pose of the base in the frame of the local map.
        score: Mean likelihood of the points, 0 to 1.
        is_unique: Whether no pose elsewhere in the window scores nearly as well, except along
            ``degenerate_direction``.
        degenerate_direction: Unit vector (2,), along the axes of the local map, along which other poses score
            nearly as well, as in a smooth corridor; zeros if there is none.
    """

    base_pose: Pose2
    score: float
    is_unique: bool
    degenerate_direction: np.ndarray


def search_exhaustively(
    cloud: PointCloud,
    local_map: LocalMap,
    guess: Pose2,
    window: SearchWindow,
    variance: np.ndarray,
    unseen_fraction: float = 0.0,
) -> Pose2:
    """Find the best pose of a small window, in steps of two cells.

    A pose replaces the guess only if a certain share of the scan supports it: a person ahead of the robot
    affects a few beams, whereas a wheel slip affects all of them.

    Args:
        cloud: Points of the scan, in the base frame.
        local_map: Map to match to.
        guess: Expected pose of the base in the frame of the local map.
        window: Search window around the guess.
        variance: (3,), of the guess [m^2, m^2, rad^2].
        unseen_fraction: Fraction of the scan, 0 to 1, that the map does not cover, and that is likely to
            match something else at another pose.

    Returns:
        Best pose of the base in the frame of the local map.
    """
    best = _search_exhaustively(
        *local_map.packed_layers,
        cloud.points_xy,
        local_map.to_grid(guess),
        max(1, round(window.distance / (2.0 * local_map.resolution))),
        max(1, round(window.angle / _NEAR_ANGLE_STEP)),
        (2.0 * local_map.resolution) ** 2 / variance[0],
        _NEAR_ANGLE_STEP**2 / variance[2],
        max(_OVERRULING_SHARE, _OVERRULING_POINTS / max(len(cloud), 1)) + unseen_fraction,
    )
    return local_map.from_grid(best)


_NEAR_ANGLE_STEP = 0.02
# Share of a scan that another pose must gain to replace the guess, least number of points (a person may be
# all that is in range), and chi-square at which half of that is needed.
_OVERRULING_SHARE, _OVERRULING_POINTS, _HALF_CHI_SQUARE = 0.15, 12.0, 9.0


def score_poses(
    cloud: PointCloud, local_map: LocalMap, poses: Sequence[Pose2], match_sides: bool = False
) -> np.ndarray:
    """Compute the mean likelihood of the points at each of several poses.

    Args:
        cloud: Points of the scan, in the base frame.
        local_map: Map to match to.
        poses: Poses of the base in the frame of the local map, N.
        match_sides: Whether a point on the other side of a wall has likelihood 0, even if it is near.

    Returns:
        (N,), 0 to 1.
    """
    in_grid = np.array([local_map.to_grid(pose) for pose in poses])
    return _scores(*local_map.packed_layers, cloud.points_xy, cloud.normals_xy, in_grid, match_sides)


@numba.njit(cache=True, nogil=True)
def _scores(fine, coarse, geometry, points, normals, poses, match_sides):
    layers = unpacked(fine, coarse, geometry)
    found = np.empty(len(poses))
    for i in range(len(poses)):
        total, c, s = 0, math.cos(poses[i, 2]), math.sin(poses[i, 2])
        for p in range(len(points)):
            x, y = (
                poses[i, 0] + c * points[p, 0] - s * points[p, 1],
                poses[i, 1] + s * points[p, 0] + c * points[p, 1],
            )
            number, row, col = cell_of(layers, x, y)
            if number >= 0 and not (match_sides and _is_opposed(layers[number], row, col, normals[p], c, s)):
                total += layers[number][1][row, col]
        found[i] = total / (255.0 * len(points))
    return found


@numba.njit(cache=True, nogil=True)
def _is_opposed(layer, row, col, normal, c, s):
    """Whether the nearest map point is on the other side of a wall from a point of a rotated ``normal``."""
    nearest, _, _, map_normals, _, _ = layer
    i = nearest[row, col]
    return i >= 0 and turned_cosine(normal, map_normals[i], c, s) < OPPOSED


@numba.njit(cache=True, nogil=True)
def _search_exhaustively(
    fine, coarse, geometry, points, guess, steps, angle_steps, step_chi, angle_chi, share
):
    layers = unpacked(fine, coarse, geometry)
    (_, likelihood, _, _, resolution, _), (_, coarse_likelihood, _, _, coarse_resolution, shift) = layers
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
                total = _sum_at(coarse_likelihood, far, x + shift[0], y + shift[1], yaw, coarse_resolution)
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
    """Sum of the grid's cells that the points lie in, for a pose in metres from its corner."""
    total = 0
    c, s = math.cos(yaw), math.sin(yaw)
    for p in range(len(points)):
        q = int(math.floor((x + c * points[p, 0] - s * points[p, 1]) / resolution))
        r = int(math.floor((y + s * points[p, 0] + c * points[p, 1]) / resolution))
        if 0 <= q < grid.shape[1] and 0 <= r < grid.shape[0]:
            total += grid[r, q]
    return total


def search_branch_and_bound(
    cloud: PointCloud, local_map: LocalMap, guess: Pose2, window: SearchWindow, min_score: float, apart: float
) -> Optional[Peak]:
    """Find the best pose of a wide window.

    The resolution is one cell, and an angle that moves distant points by about one cell.

    Args:
        cloud: Points of the scan, in the base frame.
        local_map: Map to match to.
        guess: Middle of the window, in the frame of the local map.
        window: Search window around the guess.
        min_score: Least score, 0 to 1.
        apart: Distance [m] from the best pose, or 0.5 rad of heading, above which another pose counts as
            elsewhere (see ``Peak.is_unique``).

    Returns:
        The best pose, None if none scores ``min_score``.
    """
    if len(cloud) == 0:
        return None
    resolution = local_map.resolution
    radius = float(np.sqrt(np.mean(np.sum(cloud.points_xy.astype(np.float64) ** 2, axis=1))))
    angle_step = 1.5 * resolution / max(radius, 1.0)
    angle_steps = math.ceil(window.angle / angle_step)
    cells = math.ceil(window.distance / resolution)
    start = local_map.to_grid(guess)
    likelihood, corner = _cropped(local_map.likelihood)
    start[:2] -= corner * resolution
    maxima = _maxima(likelihood)
    cols, rows = _rotated_cells(resolution, cloud.points_xy, start, angle_step, angle_steps)
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
    direction = np.zeros(2)
    rival, rival_score = _climb(*search, enough, enough, best, is_far, direction)
    is_unique = rival_score <= enough
    if not is_unique and abs(rival[2] - best[2]) < apart_angles:
        direction = (rival - best)[:2] / np.hypot(*(rival - best)[:2])
        _, rival_score = _climb(*search, enough, enough, best, is_far, direction)
        is_unique = rival_score <= enough
    x, y = start[:2] + (best[:2] + corner) * resolution
    yaw = wrap(start[2] + (best[2] - angle_steps) * angle_step)
    base_pose = local_map.from_grid(np.array([x, y, yaw]))
    return Peak(base_pose, score, is_unique, direction)


# Share of the best score above which a pose elsewhere makes the best one ambiguous.
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
    """The non-empty part of a grid, with an empty border, and its first (col, row)."""
    # Along the first axis the maximum is much faster than any().
    bounds = [np.flatnonzero(likelihood.max(axis=0)), np.flatnonzero(likelihood.any(axis=1))]
    if len(bounds[0]) == 0:
        return likelihood[:1, :1], np.zeros(2)
    (left, right), (low, high) = (
        (interpolated[0] - _COARSE, interpolated[-1] + 1 + _COARSE) for interpolated in bounds
    )
    return likelihood[low:high, left:right], np.array([left, low])


def _maxima(likelihood: np.ndarray) -> np.ndarray:
    """(levels + 1, rows, cols): at level k the maximum over the 2^k x 2^k cells from each cell on."""
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


# Number of coarse shifts above which it is faster to store their cells side by side.
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
def _climb(maxima, bounds, order, cols, rows, cells, min_score, enough, excluded, is_far, direction):
    """Find the best (col shift, row shift, angle index) and its score by branch and bound.

    Only scores above ``min_score`` count. Poses near the ``excluded`` one, or near the line through it along
    ``direction``, do not count. The search ends early when a score exceeds ``enough``.
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
            if is_inside and _is_apart(u - excluded[0], v - excluded[1], k - excluded[2], is_far, direction):
                best_score = stack_bounds[depth]
                best[0], best[1], best[2] = u, v, k
    return best, best_score


@numba.njit(cache=True, nogil=True)
def _split(finer, cols, rows, stack, stack_bounds, first):
    """Replace the cell at ``first`` on top of the stack by its four quarters, the best one last."""
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
def _is_apart(du, dv, dk, is_far, direction):
    """Check whether poses that differ by (du, dv, dk) are far from each other, also across ``direction``.

    ``is_far`` holds the least distance in cells and in angle steps, and the number of angle steps of a full
    turn.
    """
    cells, angles, full_turn = is_far
    along = direction[0] * du + direction[1] * dv
    turn = min(abs(dk), full_turn - abs(dk))
    return du * du + dv * dv - along * along >= cells * cells or turn >= angles
