"""What people had of a robot: HuNavSim's figures (Perez-Higueras et al., 2023).

Distances are from middle to middle.
"""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from planar import wrap
from sim_bridge.people.crowd import ROBOT_RADIUS, social_work

# Metres: proxemics (Hall, 1966).
INTIMATE, PERSONAL, SOCIAL = 0.45, 1.2, 3.6
# m/s and rad/s below both of which a robot does not move.
STILL_V, STILL_OMEGA = 0.001, 0.01


@dataclass(frozen=True)
class SocialMetrics:
    """Shares of the time that the nearest person was in the ``intimate``, ``personal``, ``social`` space.

    ``person_nearest``, ``person_distance``: the least and the mean distance to the nearest, metres.
    ``social_work``: of the social forces between robot and people over the time, m/s.
    """

    intimate: Optional[float] = None
    personal: Optional[float] = None
    social: Optional[float] = None
    person_nearest: Optional[float] = None
    person_distance: Optional[float] = None
    social_work: Optional[float] = None


def social_metrics(track: np.ndarray, people: np.ndarray) -> SocialMetrics:
    """Of a track (T, 4) of stamp, x, y, yaw, and people (T, N, 5) as in sim_bridge.people."""
    if len(track) < 2 or people.ndim != 3 or not people.shape[1]:
        return SocialMetrics()
    off = people[:, :, :2] - track[:, None, 1:3]
    nearest = np.hypot(off[..., 0], off[..., 1]).min(axis=1)
    spaces = np.searchsorted((INTIMATE, PERSONAL, SOCIAL), nearest, side="right")
    seconds = np.diff(track[:, 0], prepend=track[0, 0])
    velocities = np.gradient(track[:, 1:3], track[:, 0], axis=0)
    robots = np.column_stack((track[:, 1:3], velocities, np.full(len(track), ROBOT_RADIUS)))
    work = sum(dt * social_work(robot, each) for dt, robot, each in zip(seconds, robots, people))
    intimate, personal, social = (float((spaces == space).mean()) for space in range(3))
    return SocialMetrics(intimate, personal, social, float(nearest.min()), float(nearest.mean()), float(work))


def seconds_still(track: np.ndarray) -> float:
    """How long a robot did not move, of its track (T, 4)."""
    seconds = np.diff(track[:, 0])
    steps = np.diff(track[:, 1:], axis=0)
    is_still = (np.hypot(steps[:, 0], steps[:, 1]) < STILL_V * seconds) & (
        np.abs(wrap(steps[:, 2])) < STILL_OMEGA * seconds
    )
    return float(seconds[is_still].sum())
