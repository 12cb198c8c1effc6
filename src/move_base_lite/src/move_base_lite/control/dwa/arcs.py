"""Arcs: trajectories of constant velocity."""

import math

import numba
import numpy as np


@numba.njit(cache=True)
def arc(start, v, omega, seconds, granularity, angular_granularity):
    """Compute the poses of a trajectory of constant velocity.

    Args:
        start: (3,), pose x, y, yaw [m, rad].
        v: Speed [m/s].
        omega: Turn rate [rad/s].
        seconds: Duration [s].
        granularity: Largest distance between consecutive poses [m].
        angular_granularity: Largest rotation between consecutive poses [rad].

    Returns:
        Poses (N, 3), of which the first is ``start``.
    """
    steps = _steps(v, omega, seconds, granularity, angular_granularity)
    dt = seconds / steps
    poses = np.empty((steps + 1, 3))
    poses[0] = start
    for i in range(steps):
        heading = poses[i, 2] + 0.5 * omega * dt
        poses[i + 1, 0] = poses[i, 0] + v * dt * math.cos(heading)
        poses[i + 1, 1] = poses[i, 1] + v * dt * math.sin(heading)
        poses[i + 1, 2] = poses[i, 2] + omega * dt
    return poses


@numba.njit(cache=True)
def _steps(v, omega, seconds, granularity, angular_granularity):
    return max(
        1, int(math.ceil(max(abs(v) * seconds / granularity, abs(omega) * seconds / angular_granularity)))
    )
