"""Scan matching: the pose near a first guess at which a scan fits the map best.

Gauss-Newton on the likelihood field, interpolated between cells (Kohlbrecher et al., "A flexible and scalable
SLAM system with full 3D motion estimation", 2011), with the guess's own covariance as a prior: where the map
says nothing, as along a corridor, the guess stands.
"""

import math

import numba
import numpy as np

from amcl_lite.likelihood_field import LikelihoodField
from planar import Pose2

# Standard deviation of a beam's misfit (1 - fit) at the right pose; what a typical lidar and map leave over.
_MISFIT_SPREAD = 0.25
_ITERATIONS = 10
# The field to this power is one of half the sigma: what stands before a wall does not pull at the pose any
# more.
_SHARPNESS = 4


def matched(guess: Pose2, covariance: np.ndarray, points_xy: np.ndarray, field: LikelihoodField) -> Pose2:
    """The most probable pose near a guess with ``covariance`` (3, 3); beam ends (N, 2) in the base frame."""
    origin = field.origin
    in_grid = origin.inverse() @ guess
    start = np.array((in_grid.x / field.resolution, in_grid.y / field.resolution, in_grid.yaw))
    c, s = math.cos(origin.yaw), math.sin(origin.yaw)
    into_grid = np.array(((c, s, 0.0), (-s, c, 0.0), (0.0, 0.0, field.resolution))) / field.resolution
    spread = into_grid @ covariance @ into_grid.T
    information = np.linalg.inv(spread + np.diag((1e-3, 1e-3, 1e-6)))
    found = _matched(start, information, points_xy / field.resolution, field.fit, field.fit_outside)
    found[:2] *= field.resolution
    return origin @ Pose2.from_array(found)


@numba.njit(cache=True)
def _matched(start, prior, points, fit, outside):
    """The better of two sharp matches: one from the start itself, one from where a blunt match leads."""
    blunt, _ = _descended(start, start, prior, points, fit, outside, 1)
    near, near_cost = _descended(start, start, prior, points, fit, outside, _SHARPNESS)
    far, far_cost = _descended(blunt, start, prior, points, fit, outside, _SHARPNESS)
    return near if near_cost <= far_cost else far


@numba.njit(cache=True)
def _descended(first, start, prior, points, fit, outside, sharpness):
    """The best pose on the way down from ``first``, and its cost."""
    pose = first.copy()
    best, best_cost = pose.copy(), np.inf
    for _ in range(_ITERATIONS):
        cost, gradient, hessian = _linearized(pose, start, prior, points, fit, outside, sharpness)
        if cost >= best_cost:
            break
        best, best_cost = pose.copy(), cost
        step = np.linalg.solve(hessian, gradient)
        pose = pose - step
        if abs(step[0]) + abs(step[1]) < 1e-3 and abs(step[2]) < 1e-5:
            break
    return best, best_cost


@numba.njit(cache=True)
def _linearized(pose, start, prior, points, fit, outside, sharpness):
    """Cost, gradient (3,) and Gauss-Newton Hessian (3, 3) of misfits and prior at a pose in cells."""
    weight = 1.0 / _MISFIT_SPREAD**2
    gradient, hessian, cost = np.zeros(3), prior.copy(), 0.0
    for j in range(3):
        for k in range(3):
            gradient[j] += prior[j, k] * (pose[k] - start[k])
        cost += 0.5 * gradient[j] * (pose[j] - start[j])
    c, s = math.cos(pose[2]), math.sin(pose[2])
    jacobian = np.empty(3)
    for i in range(points.shape[0]):
        x, y = c * points[i, 0] - s * points[i, 1], s * points[i, 0] + c * points[i, 1]
        value, slope_x, slope_y = _interpolated(fit, outside, pose[0] + x - 0.5, pose[1] + y - 0.5)
        power = 1.0
        for _ in range(sharpness - 1):
            power *= value
        steepness, misfit = sharpness * power, 1.0 - power * value
        jacobian[0] = -steepness * slope_x
        jacobian[1] = -steepness * slope_y
        jacobian[2] = steepness * (slope_x * y - slope_y * x)
        cost += 0.5 * weight * misfit * misfit
        for j in range(3):
            gradient[j] += weight * jacobian[j] * misfit
            for k in range(3):
                hessian[j, k] += weight * jacobian[j] * jacobian[k]
    return cost, gradient, hessian


@numba.njit(cache=True, inline="always")
def _interpolated(fit, outside, col, row):
    """Value of the field between four cell centres, and its slopes per cell along columns and rows."""
    if col < 0.0 or row < 0.0 or col >= fit.shape[1] - 1 or row >= fit.shape[0] - 1:
        return outside, 0.0, 0.0
    i, j = int(row), int(col)
    u, v = col - j, row - i
    left, right = (1.0 - v) * fit[i, j] + v * fit[i + 1, j], (1.0 - v) * fit[i, j + 1] + v * fit[i + 1, j + 1]
    low, high = (1.0 - u) * fit[i, j] + u * fit[i, j + 1], (1.0 - u) * fit[i + 1, j] + u * fit[i + 1, j + 1]
    return (1.0 - u) * left + u * right, right - left, high - low
