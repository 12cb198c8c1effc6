"""What a particle set says about where the robot is."""

import math

import numba
import numpy as np

from amcl_lite.bins import cluster_labels
from amcl_lite.particles import ParticleSet
from planar import Pose2

# All particles this close to their mean, metres along x and along y: the filter has converged (amcl).
_CONVERGED_WITHIN = 0.5


def best_cluster(particles: ParticleSet) -> ParticleSet:
    """The heaviest group of particles: one of several hypotheses, never something between two."""
    labels = cluster_labels(particles.poses)
    chosen = labels == int(np.argmax(np.bincount(labels, particles.weights)))
    weights = particles.weights[chosen]
    return ParticleSet(particles.poses[chosen], weights / weights.sum())


def mean_pose(particles: ParticleSet) -> Pose2:
    """The weighted mean of a set; headings are averaged on the circle."""
    x, y, c, s = _weighted_sums(particles.poses, particles.weights)
    return Pose2(float(x), float(y), math.atan2(s, c))


def covariance(particles: ParticleSet) -> np.ndarray:
    """The covariance (3, 3) of the whole set, in m^2 and rad^2; heading is not correlated with position.

    The variance of heading is that of circular statistics, -2 ln R.
    """
    poses, weights = particles.poses, particles.weights
    x, y, c, s = _weighted_sums(poses, weights)
    dx, dy = poses[:, 0] - x, poses[:, 1] - y
    result = np.zeros((3, 3))
    result[0, 0], result[1, 1] = (weights * dx * dx).sum(), (weights * dy * dy).sum()
    result[0, 1] = result[1, 0] = (weights * dx * dy).sum()
    result[2, 2] = -2.0 * math.log(min(max(math.hypot(c, s), 1e-12), 1.0))
    return result


@numba.njit(cache=True)
def _weighted_sums(poses, weights):
    """Weighted sums (4,) of x, y, cos(yaw), sin(yaw).

    Added up in order: numpy's last bit depends on where in memory its arrays lie.
    """
    sums = np.zeros(4)
    for i in range(weights.size):
        sums[0] += weights[i] * poses[i, 0]
        sums[1] += weights[i] * poses[i, 1]
        sums[2] += weights[i] * math.cos(poses[i, 2])
        sums[3] += weights[i] * math.sin(poses[i, 2])
    return sums


def has_converged(particles: ParticleSet) -> bool:
    """Whether every particle is near the unweighted mean, along x and along y."""
    positions_xy = particles.poses[:, :2]
    return bool(np.all(np.abs(positions_xy - positions_xy.mean(axis=0)) <= _CONVERGED_WITHIN))
