"""Escape from a collision: the footprint overlaps an obstacle, so every trajectory starts in collision."""

import math
from typing import Optional

import numba
import numpy as np

from move_base_lite.costmap import LayeredCostmap
from move_base_lite.costmap.footprint import count_contacts
from planar import Pose2, Twist2

SPEED = 0.1
TURN_RATE = 0.4
SECONDS = 1.5
STEPS = 15


def escape_command(costmap: LayeredCostmap, base_pose: Pose2) -> Optional[Twist2]:
    """Find a slow velocity along which fewer and fewer points of the footprint are in collision.

    Args:
        costmap: The local costmap.
        base_pose: Robot pose in the costmap's frame.

    Returns:
        The velocity that ends with the fewest contacts; None if no velocity reduces them.
    """
    window = costmap.window
    candidates = np.array(
        [(v, omega) for v in (-SPEED, SPEED, 0.0) for omega in (0.0, TURN_RATE, -TURN_RATE) if v or omega]
    )
    best = _least_contacts(
        costmap.costs,
        window.origin_x,
        window.origin_y,
        window.resolution,
        costmap.outline_xy,
        base_pose.as_array(),
        candidates,
    )
    return None if best < 0 else Twist2(*map(float, candidates[best]))


@numba.njit(cache=True)
def _least_contacts(costs, origin_x, origin_y, resolution, outline_xy, start, candidates):
    """Index of the best candidate (N, 2), -1 if none has fewer contacts than the start pose (3,)."""
    contacts = count_contacts(costs, origin_x, origin_y, resolution, outline_xy, start[0], start[1], start[2])
    best, fewest = -1, contacts
    dt = SECONDS / STEPS
    for i in range(candidates.shape[0]):
        v, omega = candidates[i]
        x, y, yaw = start
        for _ in range(STEPS):
            x += v * dt * math.cos(yaw)
            y += v * dt * math.sin(yaw)
            yaw += omega * dt
            count = count_contacts(costs, origin_x, origin_y, resolution, outline_xy, x, y, yaw)
            if count > contacts:
                break
        else:
            if count < fewest:
                best, fewest = i, count
    return best
