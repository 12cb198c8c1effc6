"""Continuous refinement of a pose: point-to-line ICP against a local map.

A. Censi, "An ICP variant using a point-to-line metric", ICRA 2008. The map's points and their normals define
the lines, and each residual is weighted by Geman and McClure's robust cost. Points are not matched to the
other side of a wall: that would move the two sides closer by the thickness of the wall.
"""

import math

import numba
import numpy as np

from planar import Pose2
from slam_lite.matching.local_map import OPPOSED, LocalMap, Match, are_far, cell_of, turned_cosine, unpacked
from slam_lite.point_cloud import PointCloud

_MAX_STEPS = 20
# Scale of the robust cost [m]: a residual of this size keeps a quarter of its weight.
_OUTLIER_SCALE = 0.07
# Initial scale of distant points [m], which a small rotation moves far. It is halved from step to step.
_FAR_SCALE = 0.56
# Largest residual of a point that counts for the response [m].
_ON_SURFACE = 0.1
# Standard deviation of a residual [m]; larger than the laser's noise as errors of neighbours are correlated.
_SIGMA = 0.05
# Chi-square at which the prior's weight is halved.
_PRIOR_CHI_SQUARE = 9.0
# Two normals whose cosine is more than this belong to one wall. In the fine grid lines are matched only to
# these, and corners only to corners: the points at a wall's end would pull one side to the other. In the
# coarse grid, trees and cars have no reliable normals.
_SAME_WALL = 0.5
# Weight of a point that is matched to a point instead of a line.
_CORNER_WEIGHT = 0.2


def refine(
    cloud: PointCloud, local_map: LocalMap, start: Pose2, prior: Pose2, prior_information: np.ndarray
) -> Match:
    """Find the pose near an initial one at which the points match the map's surfaces best.

    Args:
        cloud: Points of the scan, in the base frame.
        local_map: Map to match to.
        start: Initial pose of the base in the frame of the local map.
        prior: Expected pose of the base in the frame of the local map.
        prior_information: (3, 3), of ``prior``, 1 / (m, m, rad)^2; zeros for no prior.

    Returns:
        The match; its information includes that of the prior.
    """
    pose, information, response = _refine(
        *local_map.packed_layers,
        cloud.points_xy,
        cloud.normals_xy,
        local_map.to_grid(start),
        local_map.to_grid(prior),
        prior_information * _SIGMA**2,
    )
    return Match(local_map.from_grid(pose), information / _SIGMA**2, response)


@numba.njit(cache=True, nogil=True)
def _refine(fine, coarse, geometry, points, normals, start, expected, prior):
    layers = unpacked(fine, coarse, geometry)
    pose = start.copy()
    weighted_prior = prior.copy()
    far_scale = _FAR_SCALE if are_far(layers, points, start).any() else _OUTLIER_SCALE
    for _ in range(_MAX_STEPS):
        information, gradient, _ = _linearize(layers, points, normals, pose, far_scale)
        deviation = pose - expected
        deviation[2] = (deviation[2] + math.pi) % (2.0 * math.pi) - math.pi
        # Cauchy's weight: the prior must not outweigh the scan after a wheel slip.
        weighted_prior = prior / (1.0 + deviation @ prior @ deviation / (_PRIOR_CHI_SQUARE * _SIGMA**2))
        information += weighted_prior
        gradient -= weighted_prior @ deviation
        # Damping keeps the system solvable without points.
        step = np.linalg.solve(information + 1e-6 * np.eye(3), gradient)
        pose += step
        is_small = abs(step[0]) < 1e-4 and abs(step[1]) < 1e-4 and abs(step[2]) < 1e-5
        if is_small and far_scale == _OUTLIER_SCALE:
            break
        far_scale = max(_OUTLIER_SCALE, 0.5 * far_scale)
    information, _, on_surface = _linearize(layers, points, normals, pose, _OUTLIER_SCALE)
    return pose, information + weighted_prior, on_surface / max(len(points), 1)


@numba.njit(cache=True, nogil=True)
def _linearize(layers, points, normals, pose, far_scale):
    h00, h01, h02, h11, h12, h22 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    g0, g1, g2 = 0.0, 0.0, 0.0
    c, s = math.cos(pose[2]), math.sin(pose[2])
    on_surface = 0
    for p in range(len(points)):
        rx, ry = c * points[p, 0] - s * points[p, 1], s * points[p, 0] + c * points[p, 1]
        x, y = rx + pose[0], ry + pose[1]
        number, row, col = cell_of(layers, x, y)
        if number < 0 or layers[number][0][row, col] < 0:
            continue
        nearest, _, map_points, map_normals, _, shift = layers[number]
        i = nearest[row, col]
        ex, ey = x + shift[0] - map_points[i, 0], y + shift[1] - map_points[i, 1]
        nx, ny = map_normals[i, 0], map_normals[i, 1]
        cosine = turned_cosine(normals[p], map_normals[i], c, s)
        if cosine < OPPOSED:
            continue
        scale = _OUTLIER_SCALE if number == 0 else far_scale
        if nx != 0.0 or ny != 0.0:
            error = ex * nx + ey * ny
            w = 1.0 / (1.0 + (error / scale) ** 2) ** 2 if cosine > _SAME_WALL or number > 0 else 0.0
            jt = ny * rx - nx * ry
            g0, g1, g2 = g0 - w * nx * error, g1 - w * ny * error, g2 - w * jt * error
            h00, h01, h02 = h00 + w * nx * nx, h01 + w * nx * ny, h02 + w * nx * jt
            h11, h12, h22 = h11 + w * ny * ny, h12 + w * ny * jt, h22 + w * jt * jt
        else:
            error = math.hypot(ex, ey)
            w = _CORNER_WEIGHT / (1.0 + (error / scale) ** 2) ** 2
            if number == 0 and (normals[p, 0] != 0.0 or normals[p, 1] != 0.0):
                w = 0.0
            g0, g1, g2 = g0 - w * ex, g1 - w * ey, g2 - w * (rx * ey - ry * ex)
            h00, h02 = h00 + w, h02 - w * ry
            h11, h12, h22 = h11 + w, h12 + w * rx, h22 + w * (rx * rx + ry * ry)
        if abs(error) < _ON_SURFACE:
            on_surface += 1
    information = np.array([[h00, h01, h02], [h01, h11, h12], [h02, h12, h22]])
    return information, np.array([g0, g1, g2]), on_surface
