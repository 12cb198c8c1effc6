"""Scan matching: the pose near a first guess at which a scan fits the map best.

Gauss-Newton on the likelihood field, interpolated between cells (Kohlbrecher et al., "A flexible and scalable
SLAM system with full 3D motion estimation", 2011), with the guess's own covariance as a prior: where the map
gives no information, as along a corridor, the guess is kept.
"""

import math

import numba
import numpy as np

from amcl_lite.sensor.likelihood_field import LikelihoodField, pose_in_cells
from planar import Pose2

# Standard deviation of a beam's misfit (1 - fit) at the correct pose, for a typical lidar and map.
_MISFIT_SPREAD = 0.25
# The field to this power has half the sigma: objects in front of a wall then have no influence.
_SHARPNESS = 4
# The descent ends after so many steps, or with a step shorter than this [cells, rad].
_STEPS, _SMALL_STEP, _SMALL_TURN = 10, 0.01, 1e-4
# A match farther from the guess than so many standard deviations, enlarged by _MARGIN [m, rad], is rejected:
# it matches an unmapped object with another wall.
_FARTHEST, _MARGIN = 4.0, 0.05
# Two descents that end this close to each other have found the same pose [cells].
_SAME_PLACE = 0.5


def match_scan(guess: Pose2, covariance: np.ndarray, points_xy: np.ndarray, field: LikelihoodField) -> Pose2:
    """Find the most probable pose near a guess.

    Args:
        guess: First guess of the base in the map.
        covariance: Covariance (3, 3) of the guess [m^2, rad^2].
        points_xy: End points of the beams (N, 2) in the base frame [m].
        field: Likelihood field of the map.

    Returns:
        The matched pose, or the guess if no match is close enough.
    """
    into = field.map_to_cells
    jacobian = np.array(((into.cos, -into.sin, 0.0), (into.sin, into.cos, 0.0), (0.0, 0.0, 1.0)))
    spread = jacobian @ covariance @ jacobian.T + np.diag((1e-3, 1e-3, 1e-6))
    margin = np.diag((_MARGIN * into.scale, _MARGIN * into.scale, _MARGIN)) ** 2
    return field.pose_from_cells(
        *_matched(guess.x, guess.y, guess.yaw, spread, margin, points_xy, into, field.fit)
    )


@numba.njit(cache=True)
def _matched(x, y, yaw, spread, margin, points_xy, map_to_cells, fit):
    """Return the better of two matches: from the guess, and from the result on the smooth field.

    Returns the guess if neither is close enough to it.
    """
    col, row, _, _ = pose_in_cells(x, y, yaw, map_to_cells)
    start, prior, points = (
        (col, row, yaw + map_to_cells.yaw),
        inverse(spread),
        points_xy * map_to_cells.scale,
    )
    belief = inverse(spread + margin)
    near, near_cost = _descended(start, start, prior, points, fit, _SHARPNESS)
    if not _is_within_reach(near, start, belief):
        near, near_cost = start, np.inf
    blunt, _ = _descended(start, start, prior, points, fit, 1)
    if abs(blunt[0] - near[0]) + abs(blunt[1] - near[1]) < _SAME_PLACE:
        return near
    far, far_cost = _descended(blunt, start, prior, points, fit, _SHARPNESS)
    return far if far_cost < near_cost and _is_within_reach(far, start, belief) else near


@numba.njit(cache=True)
def _is_within_reach(pose, start, belief):
    off = np.array((pose[0] - start[0], pose[1] - start[1], pose[2] - start[2]))
    far = _product(belief, off)
    return off[0] * far[0] + off[1] * far[1] + off[2] * far[2] <= _FARTHEST**2


@numba.njit(cache=True)
def _descended(first, start, prior, points, fit, sharpness):
    """Descend from ``first`` and return the best pose and its cost."""
    pose = best = first
    best_cost = np.inf
    for _ in range(_STEPS):
        cost, gradient, hessian = _linearized(pose, start, prior, points, fit, sharpness)
        if cost >= best_cost:
            break
        best, best_cost = pose, cost
        step = _product(inverse(hessian), gradient)
        pose = (pose[0] - step[0], pose[1] - step[1], pose[2] - step[2])
        if abs(step[0]) + abs(step[1]) < _SMALL_STEP and abs(step[2]) < _SMALL_TURN:
            break
    return best, best_cost


@numba.njit(cache=True, fastmath=True)
def _linearized(pose, start, prior, points, fit, sharpness):
    """Cost, gradient (3,) and Gauss-Newton Hessian (3, 3) of misfits and prior at a pose in cells."""
    c, s = math.cos(pose[2]), math.sin(pose[2])
    misfits, g0, g1, g2 = 0.0, 0.0, 0.0, 0.0
    h00, h01, h02, h11, h12, h22 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(points.shape[0]):
        x, y = c * points[i, 0] - s * points[i, 1], s * points[i, 0] + c * points[i, 1]
        value, slope_x, slope_y = _interpolated(fit, pose[0] + x - 0.5, pose[1] + y - 0.5)
        power = 1.0
        for _ in range(sharpness - 1):
            power *= value
        misfit = 1.0 - power * value
        j0, j1 = -sharpness * power * slope_x, -sharpness * power * slope_y
        j2 = j1 * x - j0 * y
        misfits += misfit * misfit
        g0, g1, g2 = g0 + j0 * misfit, g1 + j1 * misfit, g2 + j2 * misfit
        h00, h01, h02 = h00 + j0 * j0, h01 + j0 * j1, h02 + j0 * j2
        h11, h12, h22 = h11 + j1 * j1, h12 + j1 * j2, h22 + j2 * j2
    weight = 1.0 / _MISFIT_SPREAD**2
    off = np.array((pose[0] - start[0], pose[1] - start[1], pose[2] - start[2]))
    pull = _product(prior, off)
    cost = 0.5 * (weight * misfits + off[0] * pull[0] + off[1] * pull[1] + off[2] * pull[2])
    gradient = weight * np.array((g0, g1, g2)) + pull
    hessian = weight * np.array(((h00, h01, h02), (h01, h11, h12), (h02, h12, h22))) + prior
    return cost, gradient, hessian


@numba.njit(cache=True, inline="always")
def _interpolated(fit, col, row):
    """Value of the field between four cell centres, and its slopes per cell along columns and rows."""
    if col < 0.0 or row < 0.0 or col >= fit.shape[1] - 1 or row >= fit.shape[0] - 1:
        return np.float64(fit[0, 0]), 0.0, 0.0
    i, j = int(row), int(col)
    u, v = col - j, row - i
    left, right = (1.0 - v) * fit[i, j] + v * fit[i + 1, j], (1.0 - v) * fit[i, j + 1] + v * fit[i + 1, j + 1]
    low, high = (1.0 - u) * fit[i, j] + u * fit[i, j + 1], (1.0 - u) * fit[i + 1, j] + u * fit[i + 1, j + 1]
    return (1.0 - u) * left + u * right, right - left, high - low


@numba.njit(cache=True)
def inverse(matrix):
    """Invert a (3, 3) matrix without LAPACK, which would start threads."""
    cofactors = np.empty((3, 3))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        for m in range(3):
            n, o = (m + 1) % 3, (m + 2) % 3
            cofactors[m, i] = matrix[j, n] * matrix[k, o] - matrix[j, o] * matrix[k, n]
    determinant = 0.0
    for m in range(3):
        determinant += matrix[0, m] * cofactors[m, 0]
    return cofactors / determinant


@numba.njit(cache=True)
def _product(matrix, vector):
    product = np.zeros(3)
    for i in range(3):
        for j in range(3):
            product[i] += matrix[i, j] * vector[j]
    return product
