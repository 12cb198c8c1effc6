"""KLD-sampling: resampling with an adaptive number of particles (Probabilistic Robotics, table 8.4)."""

import math
from typing import Callable

import numba
import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.filter import bins
from amcl_lite.filter.particles import ParticleSet, equally_weighted

DrawPoses = Callable[[int, np.random.Generator], np.ndarray]


def resample(
    particles: ParticleSet,
    settings: LocalizerSettings,
    injected_share: float,
    draw_poses: DrawPoses,
    rng: np.random.Generator,
) -> ParticleSet:
    """Resample particles by weight, with a number determined by KLD-sampling.

    Args:
        particles: Weighted particles.
        settings: Bounds of the number, KLD error and quantile, resampling method.
        injected_share: Expected share of new poses.
        draw_poses: Draws the new poses: ``draw_poses(count, rng)`` returns (count, 3).
        rng: Source of randomness.

    Returns:
        Particles of equal weight.
    """
    capacity = settings.max_particles
    cumulative = np.cumsum(particles.weights)
    is_new = rng.random(capacity) < injected_share
    new = draw_poses(int(np.count_nonzero(is_new)), rng) if injected_share > 0.0 else np.empty((0, 3))
    bounds = (settings.min_particles, capacity, settings.kld_error, settings.kld_quantile)
    drawn, new_count = _draw_until_enough(
        particles.poses, cumulative, rng.random(capacity), is_new, new, bounds
    )
    if settings.resample_method == "systematic":
        drawn = _drawn_systematically(cumulative, len(drawn), rng.random())
    return equally_weighted(np.concatenate((particles.poses[drawn], new[:new_count])))


def particles_needed(occupied_bins: int, minimum: int, maximum: int, error: float, z: float) -> int:
    """Return the number of particles that bounds the KL distance by ``error`` (Fox, 2003, equation 12)."""
    return _particles_needed(occupied_bins, minimum, maximum, error, z)


@numba.njit(cache=True)
def _drawn_systematically(cumulative, count, chance):
    """Low-variance resampling (table 4.4): indices (count,) drawn by weight with one random number."""
    drawn, last = np.empty(count, dtype=np.int64), cumulative.size - 1
    j = 0
    for i in range(count):
        share = (i + chance) / count * cumulative[last]
        while j < last and cumulative[j] <= share:
            j += 1
        drawn[i] = j
    return drawn


@numba.njit(cache=True)
def _particles_needed(occupied_bins, minimum, maximum, error, z):
    if occupied_bins <= 1:
        return maximum
    k = occupied_bins - 1.0
    x = 1.0 - 2.0 / (9.0 * k) + math.sqrt(2.0 / (9.0 * k)) * z
    return int(min(max(math.ceil(k / (2.0 * error) * x * x * x), minimum), maximum))


@numba.njit(cache=True)
def _draw_until_enough(poses, cumulative, chances, is_new, new, bounds):
    """Draw particles by weight, and new poses, until KLD-sampling has enough.

    Returns the indices of the particles drawn and the number of new poses used.
    """
    table = bins.new_table(chances.size)
    drawn = np.empty(chances.size, dtype=np.int64)
    occupied, old_count, new_count = 0, 0, 0
    for i in range(chances.size):
        if is_new[i]:
            x, y, yaw = new[new_count]
            new_count += 1
        else:
            j = np.searchsorted(cumulative, chances[i] * cumulative[-1], side="right")
            j = min(j, cumulative.size - 1)
            drawn[old_count] = j
            old_count += 1
            x, y, yaw = poses[j]
        col, row, turn = bins.bin_of(x, y, yaw)
        if bins.insert(table, col, row, turn):
            occupied += 1
        if i >= _particles_needed(occupied, *bounds):
            break
    return drawn[:old_count], new_count
