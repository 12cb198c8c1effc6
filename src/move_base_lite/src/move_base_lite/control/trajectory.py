"""What a local planner chooses."""

from dataclasses import dataclass

import numpy as np

from planar import Twist2


@dataclass(frozen=True, eq=False)
class Trajectory:
    """The chosen velocity, where it leads, poses (N, 3) in the costmap's frame, and its cost."""

    command: Twist2
    poses: np.ndarray
    cost: float
