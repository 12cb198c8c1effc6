"""Social navigation metrics of HuNavSim (Perez-Higueras et al., 2023).

Distances are from centre to centre.
"""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from planar import wrap
from sim_bridge.people.crowd import ROBOT_RADIUS, social_work

# Radii of the personal spaces [m] (proxemics; Hall, 1966).
INTIMATE, PERSONAL, SOCIAL = 0.45, 1.2, 3.6
# Below both speeds [m/s, rad/s] the robot counts as standing still.
STILL_V, STILL_OMEGA = 0.001, 0.01


@dataclass(frozen=True)
class SocialMetrics:
    """Social navigation metrics of a run; None if it has no pedestrians.

    Attributes:
        intimate: Share of the time with the nearest pedestrian in the intimate space.
        personal: The same in the personal space.
        social: The same in the social space.
        person_nearest: Minimum distance to the nearest pedestrian [m].
        person_distance: Mean distance to the nearest pedestrian [m].
        social_work: Social forces between robot and pedestrians, integrated over time [m/s].
    """

    intimate: Optional[float] = None
    personal: Optional[float] = None
    social: Optional[float] = None
    person_nearest: Optional[float] = None
    person_distance: Optional[float] = None
    social_work: Optional[float] = None


def social_metrics(track: np.ndarray, people: np.ndarray) -> SocialMetrics:
    """Compute the metrics of a run.

    Args:
        track: (T, 4) stamp, x, y, yaw of the robot.
        people: (T, N, 5) x, y, velocity in x and y, radius of each pedestrian.
    """
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
    """Return the time [s] without motion of a track (T, 4)."""
    seconds = np.diff(track[:, 0])
    steps = np.diff(track[:, 1:], axis=0)
    is_still = (np.hypot(steps[:, 0], steps[:, 1]) < STILL_V * seconds) & (
        np.abs(wrap(steps[:, 2])) < STILL_OMEGA * seconds
    )
    return float(seconds[is_still].sum())
