"""Continuous refinement of a pose: point-to-line ICP against a local map.

A. Censi, "An ICP variant using a point-to-line metric", ICRA 2008; the map's points and their normals stand
for the lines, and each residual is weighted by Geman and McClure's robust cost. Points are not drawn to the
other side of a wall: that would make two rooms one wall's thickness too close.
"""

import math

import numba
import numpy as np

from planar import Pose2
from slam_lite.matching.local_map import OPPOSED, LocalMap, Match, are_far, cell_of, turned_cosine
from slam_lite.surface import Surface

_MAX_STEPS = 20
# Scale of the robust cost, metres: a residual of this size has a quarter of its weight left.
_OUTLIER_SCALE = 0.07
# The same of points far off, at first: there a small turn is a long way. It is halved from step to step.
_FAR_SCALE = 0.56
# A point is on a surface if it is not farther from it than this, metres.
_ON_SURFACE = 0.1
# Standard deviation, metres, of one residual; larger than the laser's noise because neighbours err together.
_SIGMA = 0.05
# Chi-square at which the belief in the prior is halved.
_FREE_CHI_SQUARE = 9.0
# Two normals whose cosine is more than this belong to one wall. Only these pull in the fine grid, and corners
# only corners: the points of a wall's end would pull one side to the other. In the coarse one a tree or a car
# is of no kind for sure.
_ALIKE = 0.5
# Weight of a point that has no line to be drawn to, only a point.
_CORNER_WEIGHT = 0.2


def refine(
    surface: Surface, local_map: LocalMap, start: Pose2, prior: Pose2, prior_information: np.ndarray
) -> Match:
    """The pose near ``start`` at which ``surface`` lies best on the map's surfaces.

    ``prior``: where the base is believed to be, with ``prior_information`` (3, 3), zeros for no belief at
    all.
    """
    pose, information, response = _refine(
        local_map.layers,
        surface.points_xy,
        surface.normals_xy,
        local_map.to_grid(start),
        local_map.to_grid(prior),
        prior_information * _SIGMA**2,
    )
    return Match(local_map.from_grid(pose), information / _SIGMA**2, response)


@numba.njit(cache=True, nogil=True)
def _refine(layers, points, normals, start, believed, prior):
    pose = start.copy()
    weighted_prior = prior.copy()
    far_scale = _FAR_SCALE if are_far(layers, points, start).any() else _OUTLIER_SCALE
    for _ in range(_MAX_STEPS):
        information, gradient, _ = _linearize(layers, points, normals, pose, far_scale)
        deviation = pose - believed
        deviation[2] = (deviation[2] + math.pi) % (2.0 * math.pi) - math.pi
        # Cauchy's weight: wheels that slipped must not pull the pose off what is seen.
        weighted_prior = prior / (1.0 + deviation @ prior @ deviation / (_FREE_CHI_SQUARE * _SIGMA**2))
        information += weighted_prior
        gradient -= weighted_prior @ deviation
        # A hair of damping keeps the system solvable where nothing is seen.
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
            w = 1.0 / (1.0 + (error / scale) ** 2) ** 2 if cosine > _ALIKE or number > 0 else 0.0
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
