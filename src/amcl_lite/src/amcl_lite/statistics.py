"""What a particle set says about where the robot is."""

import math

import numpy as np

from amcl_lite.bins import cluster_labels
from amcl_lite.particles import ParticleSet
from planar import Pose2

# All particles this close to their mean, metres along x and along y: the filter has converged (amcl).
_CONVERGED_WITHIN = 0.5


def mean_of_best_cluster(particles: ParticleSet) -> Pose2:
    """The mean of the heaviest group of particles: one of several hypotheses, never between two."""
    labels = cluster_labels(particles.poses)
    heaviest = int(np.argmax(np.bincount(labels, particles.weights)))
    chosen = labels == heaviest
    return mean_pose(particles.poses[chosen], particles.weights[chosen])


def mean_pose(poses: np.ndarray, weights: np.ndarray) -> Pose2:
    """The weighted mean of poses (N, 3); headings are averaged on the circle."""
    x, y = weights @ poses[:, :2] / weights.sum()
    return Pose2(float(x), float(y), math.atan2(weights @ np.sin(poses[:, 2]), weights @ np.cos(poses[:, 2])))


def covariance(particles: ParticleSet) -> np.ndarray:
    """The covariance (3, 3) of the whole set, in m^2 and rad^2; heading is not correlated with position.

    The variance of heading is that of circular statistics, -2 ln R.
    """
    positions = np.cov(particles.poses[:, :2].T, aweights=particles.weights, ddof=0)
    yaws = particles.poses[:, 2]
    resultant = math.hypot(particles.weights @ np.cos(yaws), particles.weights @ np.sin(yaws))
    result = np.zeros((3, 3))
    result[:2, :2] = positions
    result[2, 2] = -2.0 * math.log(min(max(resultant, 1e-12), 1.0))
    return result


def has_converged(particles: ParticleSet) -> bool:
    """Whether every particle is near the unweighted mean, along x and along y."""
    positions_xy = particles.poses[:, :2]
    return bool(np.all(np.abs(positions_xy - positions_xy.mean(axis=0)) <= _CONVERGED_WITHIN))
