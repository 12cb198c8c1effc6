"""KLD-sampling: a new particle set, as large as its spread requires (Probabilistic Robotics, table 8.4)."""

import math

import numba
import numpy as np

from amcl_lite import bins
from amcl_lite.config import LocalizerSettings
from amcl_lite.particles import FreeSpace, ParticleSet, equally_weighted


def resampled(
    particles: ParticleSet,
    settings: LocalizerSettings,
    injection_share: float,
    free_space: FreeSpace,
    rng: np.random.Generator,
) -> ParticleSet:
    """Particles drawn by weight until KLD-sampling has enough; about ``injection_share`` are random poses."""
    capacity = settings.max_particles
    injected = rng.random(capacity) < injection_share
    drawn = particles.poses[_drawn(particles.weights, rng.random(capacity))]
    if injected.any():
        drawn[injected] = free_space.draw(int(np.count_nonzero(injected)), rng)
    count = _count_needed(
        drawn, settings.min_particles, settings.max_particles, settings.kld_error, settings.kld_z
    )
    return equally_weighted(drawn[:count])


def particles_needed(occupied_bins: int, minimum: int, maximum: int, error: float, z: float) -> int:
    """How many particles bound the Kullback-Leibler distance by ``error`` (Fox, 2003, equation 12)."""
    return _particles_needed(occupied_bins, minimum, maximum, error, z)


def _drawn(weights: np.ndarray, uniform: np.ndarray) -> np.ndarray:
    """Indices of particles, independently drawn by weight."""
    cumulative = np.cumsum(weights)
    return np.minimum(np.searchsorted(cumulative, uniform * cumulative[-1], side="right"), len(weights) - 1)


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
