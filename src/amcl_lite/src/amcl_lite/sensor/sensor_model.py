"""Sensor models (Probabilistic Robotics, chapter 6, with the weights of amcl).

All return log-likelihoods, since a product over many beams underflows.
"""

import math

import numba
import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.sensor.beams import Beams
from amcl_lite.sensor.likelihood_field import LikelihoodField, fit_at, pose_in_cells
from planar import OccupancyGrid
from planar.geometry.pose import cos_sin
from planar.geometry.ray_casting import cast_rays_from_many


def log_likelihood_field(
    poses: np.ndarray, beams: Beams, field: LikelihoodField, settings: LocalizerSettings
) -> np.ndarray:
    """Logarithms (N,) of the likelihood field model (table 6.3), amcl's 1 + sum of cubes for the product.

    The sum forgives: a beam that the map does not explain cannot rule out a pose.
    """
    sums = _sums_of_cubes(
        poses, beams.ends_xy, field.map_to_cells, field.fit, settings.z_hit, _random(beams, settings)
    )
    return np.log1p(sums)


def log_likelihood_field_prob(
    poses: np.ndarray, beams: Beams, field: LikelihoodField, settings: LocalizerSettings, skip_beams: bool
) -> np.ndarray:
    """Logarithms (N,) of the likelihood field model (table 6.3), the product over beams.

    With ``skip_beams``, those that too few particles can explain are left out: people and moved furniture;
    unless that would leave almost none, when it is the particles that are wrong.
    """
    ends_xy = beams.ends_xy
    if skip_beams:
        explained = field.value_at_distance(settings.beam_skip_distance)
        shares = _shares_explaining(poses, ends_xy, field.map_to_cells, field.fit, explained)
        used = shares > settings.beam_skip_threshold
        if np.count_nonzero(~used) < settings.beam_skip_error_threshold * len(ends_xy):
            ends_xy = ends_xy[used]
    return _sums_of_logs(
        poses, ends_xy, field.map_to_cells, field.fit, settings.z_hit, _random(beams, settings)
    )


def log_beam_model(
    poses: np.ndarray, beams: Beams, grid: OccupancyGrid, settings: LocalizerSettings
) -> np.ndarray:
    """Logarithms (N,) of the beam model (table 6.1), with amcl's 1 + sum of cubes for the product."""
    starts = poses.copy()
    c, s = cos_sin(poses[:, 2])
    starts[:, 0] += c * beams.start_xy[0] - s * beams.start_xy[1]
    starts[:, 1] += s * beams.start_xy[0] + c * beams.start_xy[1]
    expected = cast_rays_from_many(grid, starts, beams.directions, beams.max_range)
    return np.log1p(
        _sums_of_beam_cubes(
            expected,
            beams.ranges,
            beams.max_range,
            (settings.z_hit, settings.z_short, settings.z_max, settings.z_rand),
            settings.sigma_hit,
            settings.lambda_short,
        )
    )


def mean_fits(poses: np.ndarray, ends_xy: np.ndarray, field: LikelihoodField) -> np.ndarray:
    """How well (N,), 0 to 1, beams that end at ``ends_xy`` (M, 2) fit the map on average; no probability."""
    return _sums_of_fits(poses, ends_xy, field.map_to_cells, field.fit) / max(len(ends_xy), 1)


def _random(beams: Beams, settings: LocalizerSettings) -> float:
    return settings.z_rand / beams.max_range


# Sums over beams may be taken in any order, for speed: no two orders differ by anything that matters.


@numba.njit(cache=True, fastmath=True)
def _sums_of_fits(poses, ends_xy, map_to_cells, fit):
    sums = np.empty(poses.shape[0])
    for i in range(poses.shape[0]):
        col, row, c, s = pose_in_cells(poses[i, 0], poses[i, 1], poses[i, 2], map_to_cells)
        total = 0.0
        for j in range(ends_xy.shape[0]):
            x, y = ends_xy[j, 0], ends_xy[j, 1]
            total += fit_at(fit, col + c * x - s * y, row + s * x + c * y)
        sums[i] = total
    return sums


@numba.njit(cache=True, fastmath=True)
def _sums_of_cubes(poses, ends_xy, map_to_cells, fit, z_hit, random):
    sums = np.empty(poses.shape[0])
    for i in range(poses.shape[0]):
        col, row, c, s = pose_in_cells(poses[i, 0], poses[i, 1], poses[i, 2], map_to_cells)
        total = 0.0
        for j in range(ends_xy.shape[0]):
            x, y = ends_xy[j, 0], ends_xy[j, 1]
            p = z_hit * fit_at(fit, col + c * x - s * y, row + s * x + c * y) + random
            total += p * p * p
        sums[i] = total
    return sums


@numba.njit(cache=True)
def _sums_of_logs(poses, ends_xy, map_to_cells, fit, z_hit, random):
    sums = np.empty(poses.shape[0])
    tiny = 1e-300  # z_rand may be 0
    for i in range(poses.shape[0]):
        col, row, c, s = pose_in_cells(poses[i, 0], poses[i, 1], poses[i, 2], map_to_cells)
        total = 0.0
        for j in range(ends_xy.shape[0]):
            x, y = ends_xy[j, 0], ends_xy[j, 1]
            p = z_hit * fit_at(fit, col + c * x - s * y, row + s * x + c * y) + random
            total += math.log(max(p, tiny))
        sums[i] = total
    return sums


@numba.njit(cache=True)
def _shares_explaining(poses, ends_xy, map_to_cells, fit, explained):
    counts = np.zeros(ends_xy.shape[0])
    for i in range(poses.shape[0]):
        col, row, c, s = pose_in_cells(poses[i, 0], poses[i, 1], poses[i, 2], map_to_cells)
        for j in range(ends_xy.shape[0]):
            x, y = ends_xy[j, 0], ends_xy[j, 1]
            counts[j] += fit_at(fit, col + c * x - s * y, row + s * x + c * y) > explained
    return counts / poses.shape[0]


@numba.njit(cache=True)
def _sums_of_beam_cubes(expected, ranges, max_range, z, sigma, decay):
    z_hit, z_short, z_max, z_rand = z
    sums = np.zeros(expected.shape[0])
    for i in range(expected.shape[0]):
        for j in range(ranges.size):
            error = ranges[j] - expected[i, j]
            p = z_hit * math.exp(-0.5 * (error / sigma) ** 2)
            if error < 0.0:
                p += z_short * decay * math.exp(-decay * ranges[j])
            p += z_rand / max_range if ranges[j] < max_range else z_max
            sums[i] += p * p * p
    return sums
