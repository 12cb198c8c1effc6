"""A small room with a robot that drives a circle, for the tests of slam_lite."""

import math

import numpy as np

from planar import OCCUPIED, OccupancyGrid, Pose2
from planar.geometry.ray_casting import cast_rays
from planar_ros.messages.conversion import LaserScanArrays

RESOLUTION, RANGE_MAX = 0.05, 10.0


def room() -> OccupancyGrid:
    """6 m x 4 m with a pillar, centred at (0, 0)."""
    cells = np.zeros((82, 122), dtype=np.int8)
    cells[[0, -1], :] = cells[:, [0, -1]] = cells[50:56, 80:90] = OCCUPIED
    return OccupancyGrid(cells, RESOLUTION, Pose2(-3.05, -2.05, 0.0))


def circle(angle: float) -> Pose2:
    """Robot pose after ``angle`` radians of its circle, which starts at (0, 0)."""
    return Pose2(0.8 * math.sin(angle), 0.8 - 0.8 * math.cos(angle), angle)


def sweep(
    grid: OccupancyGrid, base_in_map: Pose2, stamp, frame: str, beams: int = 360, upside_down: bool = False
):
    """Message of a 360 degree laser at the origin of the base."""
    scan = LaserScanArrays()
    scan.header.stamp, scan.header.frame_id = stamp, frame
    scan.angle_min, scan.angle_increment = -math.pi, 2.0 * math.pi / beams
    scan.range_min, scan.range_max = 0.1, RANGE_MAX
    angles = scan.angle_min + scan.angle_increment * np.arange(beams)
    seen = cast_rays(grid, base_in_map, -angles if upside_down else angles, RANGE_MAX)
    scan.ranges, scan.intensities = seen.astype(np.float32), np.zeros(0, dtype=np.float32)
    return scan
