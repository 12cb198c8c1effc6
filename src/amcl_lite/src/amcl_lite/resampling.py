"""KLD-sampling: a new particle set, as large as its spread requires (Probabilistic Robotics, table 8.4)."""

import math
from typing import Callable

import numba
import numpy as np

from amcl_lite import bins
from amcl_lite.config import LocalizerSettings
from amcl_lite.particles import ParticleSet, equally_weighted

DrawPoses = Callable[[int, np.random.Generator], np.ndarray]


def resampled(
    particles: ParticleSet,
    settings: LocalizerSettings,
    injected_share: float,
    draw_poses: DrawPoses,
    rng: np.random.Generator,
) -> ParticleSet:
    """Particles drawn by weight until KLD-sampling has enough; about ``injected_share`` are new poses.

    ``draw_poses(count, rng)`` makes the new poses, (count, 3).
    """
    capacity = settings.max_particles
    candidates = particles.poses[_drawn_independently(particles.weights, capacity, rng)]
    injected = rng.random(capacity) < injected_share
    if injected.any():
        candidates[injected] = draw_poses(int(np.count_nonzero(injected)), rng)
    count = _count_needed(
        candidates, settings.min_particles, capacity, settings.kld_error, settings.kld_quantile
    )
    if settings.resample_method == "systematic":
        kept = ~injected[:count]
        drawn = _drawn_systematically(particles.weights, int(np.count_nonzero(kept)), rng)
        candidates[:count][kept] = particles.poses[drawn]
    return equally_weighted(candidates[:count])


def particles_needed(occupied_bins: int, minimum: int, maximum: int, error: float, z: float) -> int:
    """How many particles bound the Kullback-Leibler distance by ``error`` (Fox, 2003, equation 12)."""
    return _particles_needed(occupied_bins, minimum, maximum, error, z)


def _drawn_independently(weights: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Indices (count,) of particles, each drawn by weight on its own (amcl)."""
    return _at_shares(weights, rng.random(count))


def _drawn_systematically(weights: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Indices (count,) of particles drawn by weight with one random number for all (table 4.4)."""
    return _at_shares(weights, (np.arange(count) + rng.random()) / max(count, 1))


def _at_shares(weights: np.ndarray, shares: np.ndarray) -> np.ndarray:
    cumulative = np.cumsum(weights)
    return np.minimum(np.searchsorted(cumulative, shares * cumulative[-1], side="right"), len(weights) - 1)


@numba.njit(cache=True)
def _particles_needed(occupied_bins, minimum, maximum, error, z):
    if occupied_bins <= 1:
        return maximum
    k = occupied_bins - 1.0
    x = 1.0 - 2.0 / (9.0 * k) + math.sqrt(2.0 / (9.0 * k)) * z
    return int(min(max(math.ceil(k / (2.0 * error) * x * x * x), minimum), maximum))


@numba.njit(cache=True)
def _count_needed(poses, minimum, maximum, error, z):
    table = bins.new_table(poses.shape[0])
    occupied = 0
    for i in range(poses.shape[0]):
        col, row, turn = bins.bin_of(poses[i, 0], poses[i, 1], poses[i, 2])
        if bins.insert(table, col, row, turn):
            occupied += 1
        if i >= _particles_needed(occupied, minimum, maximum, error, z):
            return i + 1
    return poses.shape[0]
