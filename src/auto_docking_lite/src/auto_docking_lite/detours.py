"""Ways around obstacles to a dock by straight legs."""

import math
from typing import Iterable, Optional, Sequence

import numpy as np

from auto_docking_lite.config import DockingSettings
from auto_docking_lite.contract import DockInputs
from auto_docking_lite.motion import is_free, obstacles_in_base
from planar import Pose2

# Bearings of stopovers before the dock [rad], and their distances as factors of the staging distance.
BEARINGS, FACTORS = (0.4, -0.4, 0.8, -0.8), (1.0, 1.6)
# Distance of stopovers around the robot [m], and their number.
DETOUR, DETOURS = 0.8, 8


def free_legs(
    inputs: DockInputs, target: Pose2, dock: Pose2, settings: DockingSettings
) -> Optional[Sequence[Pose2]]:
    """Return the positions on a free drive of straight legs to a target; None without one.

    Args:
        inputs: Pose of the robot in odom, and scan.
        target: Target in odom.
        dock: Estimated pose of the dock in odom.
        settings: Distances.
    """
    base = inputs.base_in_odom
    obstacles = base.transform_points(obstacles_in_base(inputs.scan))
    stopovers = [
        dock @ Pose2(0.0, 0.0, bearing) @ Pose2(factor * settings.staging_distance)
        for bearing in BEARINGS
        for factor in FACTORS
    ]
    stopovers += [
        base @ Pose2(0.0, 0.0, 2.0 * math.pi * number / DETOURS) @ Pose2(DETOUR) for number in range(DETOURS)
    ]
    return shortest_free(obstacles, base, target, stopovers, settings.robot_radius)


def shortest_free(
    obstacles_xy: np.ndarray, start: Pose2, end: Pose2, stopovers: Iterable[Pose2], radius: float
) -> Optional[Sequence[Pose2]]:
    """Return the shortest free drive of one or two straight legs; None if there is none.

    Args:
        obstacles_xy: Obstacles (N, 2), in the frame of the poses.
        start: Start of the drive.
        end: End of the drive.
        stopovers: Positions at which the legs may meet.
        radius: Radius of the robot [m].
    """
    if is_free(obstacles_xy, start, end, radius):
        return (end,)
    free = [
        via
        for via in stopovers
        if is_free(obstacles_xy, start, via, radius) and is_free(obstacles_xy, via, end, radius)
    ]
    if not free:
        return None
    return min(free, key=lambda via: start.distance_to(via) + via.distance_to(end)), end
