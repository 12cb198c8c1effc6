"""Statistics of a particle set: best cluster, mean, covariance, convergence."""

import math
from typing import Tuple

import numba
import numpy as np

from amcl_lite.filter.bins import cluster_labels
from amcl_lite.filter.particles import ParticleSet
from planar import Pose2

# The filter has converged if all particles are this close to their mean in x and in y [m] (amcl).
_CONVERGED_WITHIN = 0.5


def best_cluster(particles: ParticleSet) -> ParticleSet:
    """Return the cluster of largest weight: one hypothesis, never the mean of several."""
    labels = cluster_labels(particles.poses)
    if not labels.any():
        return particles
    chosen = labels == int(np.argmax(np.bincount(labels, particles.weights)))
    weights = particles.weights[chosen]
    return ParticleSet(particles.poses[chosen], weights / weights.sum())


def mean_and_covariance(particles: ParticleSet) -> Tuple[Pose2, np.ndarray]:
    """Compute the weighted mean of a set and its covariance (3, 3) [m^2, rad^2].

    Headings are averaged on the circle, their variance is that of circular statistics, -2 ln R; they are not
    correlated with positions.
    """
    x, y, c, s, xx, xy, yy = _moments(particles.poses, particles.weights)
    length = min(max(math.hypot(c, s), 1e-12), 1.0)
    covariance = np.array(((xx, xy, 0.0), (xy, yy, 0.0), (0.0, 0.0, -2.0 * math.log(length))))
    return Pose2(x, y, math.atan2(s, c)), covariance


def has_converged(particles: ParticleSet) -> bool:
    """Return whether every particle is close to the unweighted mean in x and in y."""
    return _are_all_near_mean(particles.poses, _CONVERGED_WITHIN)


@numba.njit(cache=True)
def _moments(poses, weights):
    """Return weighted means of x, y, cos(yaw), sin(yaw); variance of x, covariance, variance of y.

    Added up in order: numpy's last bit depends on where in memory its arrays lie.
    """
    x, y, c, s = 0.0, 0.0, 0.0, 0.0
    for i in range(weights.size):
        x += weights[i] * poses[i, 0]
        y += weights[i] * poses[i, 1]
        c += weights[i] * math.cos(poses[i, 2])
        s += weights[i] * math.sin(poses[i, 2])
    xx, xy, yy = 0.0, 0.0, 0.0
    for i in range(weights.size):
        dx, dy = poses[i, 0] - x, poses[i, 1] - y
        xx += weights[i] * dx * dx
        xy += weights[i] * dx * dy
        yy += weights[i] * dy * dy
    return x, y, c, s, xx, xy, yy


@numba.njit(cache=True)
def _are_all_near_mean(poses, distance):
    x, y = 0.0, 0.0
    for i in range(poses.shape[0]):
        x += poses[i, 0]
        y += poses[i, 1]
    x, y = x / poses.shape[0], y / poses.shape[0]
    for i in range(poses.shape[0]):
        if abs(poses[i, 0] - x) > distance or abs(poses[i, 1] - y) > distance:
            return False
    return True
