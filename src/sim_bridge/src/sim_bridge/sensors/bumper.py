"""A bumper in three sectors, as Kobuki's (kobuki_gazebo_plugins)."""

import math
from typing import FrozenSet

import numpy as np

LEFT, CENTRE, RIGHT = 0, 1, 2
# Each sector's bearings, rad, and the heights of the bumper, m, in the base frame.
SECTORS = {
    LEFT: (math.radians(30.0), math.radians(90.0)),
    CENTRE: (-math.radians(30.0), math.radians(30.0)),
    RIGHT: (-math.radians(90.0), -math.radians(30.0)),
}
LOWEST, HIGHEST = 0.01, 0.13


def pressed(contacts_xyz: np.ndarray) -> FrozenSet[int]:
    """The sectors that are touched; ``contacts_xyz``: (N, 3), where the robot is, in its base frame."""
    x, y, z = np.asarray(contacts_xyz, dtype=float).reshape(-1, 3).T
    bearings = np.arctan2(y, x)[(z >= LOWEST) & (z <= HIGHEST)]
    return frozenset(
        sector
        for sector, (first, last) in SECTORS.items()
        if ((bearings >= first) & (bearings <= last)).any()
    )
