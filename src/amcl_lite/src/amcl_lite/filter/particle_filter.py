"""The particle filter: prediction, weighting and resampling of a particle set."""

import math

import numba
import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.filter.particles import ParticleSet, clamped_positions
from amcl_lite.filter.resampling import DrawPoses, resample
from amcl_lite.filter.statistics import has_converged
from amcl_lite.motion.custom_model import MotionModel
from planar import Pose2


class ParticleFilter:
    """Particle filter with augmented MCL (Probabilistic Robotics, tables 8.2 and 8.3)."""

    def __init__(self, particles: ParticleSet, rng: np.random.Generator):
        self.particles = particles
        self.has_converged = False
        self._rng = rng
        self._likelihood = _LikelihoodTrend()

    def move(self, base_before: Pose2, base_now: Pose2, motion: MotionModel) -> None:
        """Predict the particles from the motion of the odometry."""
        poses = motion.moved(self.particles.poses, base_before, base_now, self._rng)
        self.particles = ParticleSet(clamped_positions(poses), self.particles.weights)

    def weigh(self, log_likelihoods: np.ndarray, settings: LocalizerSettings) -> None:
        """Multiply the weights by likelihoods, given as natural logarithms (N,)."""
        weights, likelihood = _weighted(self.particles.weights, log_likelihoods)
        self.particles = ParticleSet(self.particles.poses, weights)
        self._likelihood.add(likelihood, settings)

    def should_resample(self, settings: LocalizerSettings) -> bool:
        """Whether resampling is due: always, or with selective resampling when N_eff is below N / 2."""
        return not settings.selective_resampling or 2.0 * self.particles.effective_size <= self.particles.size

    def likelihood_drop(self) -> float:
        """Return the relative drop of the likelihood and, if positive, reset its averages."""
        return self._likelihood.likelihood_drop()

    def resample(self, settings: LocalizerSettings, share: float, draw: DrawPoses) -> None:
        """Resample by weight, with a share of new poses drawn by ``draw``."""
        self.particles = resample(self.particles, settings, share, draw, self._rng)
        self.has_converged = has_converged(self.particles)


class _LikelihoodTrend:
    """Short-term and long-term averages of the likelihood; their ratio detects a lost filter (table 8.3)."""

    def __init__(self):
        self._slow = self._fast = 0.0

    def add(self, likelihood: float, settings: LocalizerSettings) -> None:
        self._slow = _decayed(self._slow, likelihood, settings.recovery_alpha_slow)
        self._fast = _decayed(self._fast, likelihood, settings.recovery_alpha_fast)

    def likelihood_drop(self) -> float:
        """Return the drop of the short-term below the long-term average and, if positive, reset both."""
        if self._fast >= self._slow:
            return 0.0
        share = 1.0 - self._fast / self._slow
        self._slow = self._fast = 0.0
        return share


def _decayed(average: float, value: float, alpha: float) -> float:
    """Update an exponential average; 0 means that it has no value yet."""
    return value if average == 0.0 else average + alpha * (value - average)


@numba.njit(cache=True)
def _weighted(weights, log_likelihoods):
    """Return normalized products of weights and likelihoods, and their sum, without underflow.

    Particles without weight are ignored: the scan may fit only at their poses.
    """
    largest = -np.inf
    for i in range(weights.size):
        if weights[i] > 0.0:
            largest = max(largest, log_likelihoods[i])
    products, total = np.zeros(weights.size), 0.0
    for i in range(weights.size):
        if weights[i] > 0.0:
            products[i] = weights[i] * math.exp(log_likelihoods[i] - largest)
            total += products[i]
    return products / total, math.exp(largest) * total
