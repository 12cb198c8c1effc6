"""Sensor models: how likely a scan is at each particle (Probabilistic Robotics, chapter 6; amcl's weights).

All return natural logarithms, since a product of many beams underflows.
"""

import math

import numba
import numpy as np

from amcl_lite.beams import Beams
from amcl_lite.config import LocalizerSettings
from amcl_lite.likelihood_field import LikelihoodField
from planar import OccupancyGrid
from planar.ray_casting import cast_rays_from_many


def log_likelihood_field(
    poses: np.ndarray, beams: Beams, field: LikelihoodField, settings: LocalizerSettings
) -> np.ndarray:
    """Logarithms (N,) of the likelihood field model (table 6.3), amcl's 1 + sum of cubes for the product.

    The sum forgives: a beam that the map does not explain cannot rule out a pose.
    """
    return np.log1p(
        _sums_of_cubes(
            *_in_cells(poses, beams.ends_xy, field),
            field.fit,
            field.fit_outside,
            settings.z_hit,
            _random(beams, settings),
        )
    )


def log_likelihood_field_prob(
    poses: np.ndarray, beams: Beams, field: LikelihoodField, settings: LocalizerSettings, skip_beams: bool
) -> np.ndarray:
    """Logarithms (N,) of the likelihood field model (table 6.3), the product over beams.

    With ``skip_beams``, those that too few particles can explain are left out: people and moved furniture;
    unless that would leave almost none, when it is the particles that are wrong.
    """
    starts, ends = _in_cells(poses, beams.ends_xy, field)
    if skip_beams:
        explained = field.fit_at_distance(settings.beam_skip_distance)
        shares = _shares_explaining(starts, ends, field.fit, explained)
        used = shares > settings.beam_skip_threshold
        if np.count_nonzero(~used) < settings.beam_skip_error_threshold * len(ends):
            ends = ends[used]
    return _sums_of_logs(starts, ends, field.fit, field.fit_outside, settings.z_hit, _random(beams, settings))


def log_beam_model(
    poses: np.ndarray, beams: Beams, grid: OccupancyGrid, settings: LocalizerSettings
) -> np.ndarray:
    """Logarithms (N,) of the beam model (table 6.1), with amcl's 1 + sum of cubes for the product."""
    starts = poses.copy()
    c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
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
    starts, ends = _in_cells(poses, ends_xy, field)
    return _sums_of_fits(starts, ends, field.fit) / max(len(ends), 1)


def _random(beams: Beams, settings: LocalizerSettings) -> float:
    return settings.z_rand / beams.max_range


def _in_cells(poses, ends_xy, field):
    """Particles as (N, 4) col, row, cos, sin and beam ends as (M, 2), in cells of the field."""
    positions_xy = field.origin.inverse().transform_points(poses[:, :2]) / field.resolution
    yaws = poses[:, 2] - field.origin.yaw
    return np.column_stack((positions_xy, np.cos(yaws), np.sin(yaws))), ends_xy / field.resolution


@numba.njit(cache=True, inline="always")
def _fit_at(fit, outside, start, x, y):
    col = start[0] + start[2] * x - start[3] * y
    row = start[1] + start[3] * x + start[2] * y
    if col >= 0.0 and row >= 0.0 and col < fit.shape[1] and row < fit.shape[0]:
        return fit[int(row), int(col)]
    return outside


@numba.njit(cache=True)
def _sums_of_fits(starts, ends, fit):
    sums = np.zeros(starts.shape[0])
    for i in range(starts.shape[0]):
        for j in range(ends.shape[0]):
            sums[i] += _fit_at(fit, 0.0, starts[i], ends[j, 0], ends[j, 1])
    return sums


@numba.njit(cache=True)
def _sums_of_cubes(starts, ends, fit, outside, z_hit, random):
    sums = np.zeros(starts.shape[0])
    for i in range(starts.shape[0]):
        for j in range(ends.shape[0]):
            p = z_hit * _fit_at(fit, outside, starts[i], ends[j, 0], ends[j, 1]) + random
            sums[i] += p * p * p
    return sums


@numba.njit(cache=True)
def _sums_of_logs(starts, ends, fit, outside, z_hit, random):
    sums = np.zeros(starts.shape[0])
    tiny = 1e-300  # z_rand may be 0
    for i in range(starts.shape[0]):
        for j in range(ends.shape[0]):
            p = z_hit * _fit_at(fit, outside, starts[i], ends[j, 0], ends[j, 1]) + random
            sums[i] += math.log(max(p, tiny))
    return sums


@numba.njit(cache=True)
def _shares_explaining(starts, ends, fit, explained):
    counts = np.zeros(ends.shape[0])
    for i in range(starts.shape[0]):
        for j in range(ends.shape[0]):
            if _fit_at(fit, 0.0, starts[i], ends[j, 0], ends[j, 1]) > explained:
                counts[j] += 1.0
    return counts / starts.shape[0]


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
