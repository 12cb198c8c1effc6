"""Trajectories as text."""

import math

import numpy as np


def tum_text(stamped_poses: np.ndarray) -> str:
    """Stamps and poses (N, 4) as lines ``t x y z qx qy qz qw`` (the TUM format, which evo reads)."""
    return "".join(
        f"{t:.9f} {x:.6f} {y:.6f} 0 0 0 {math.sin(yaw / 2.0):.9f} {math.cos(yaw / 2.0):.9f}\n"
        for t, x, y, yaw in stamped_poses
    )
