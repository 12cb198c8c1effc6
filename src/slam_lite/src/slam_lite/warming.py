"""Ahead-of-time compilation of the numba kernels, so that they do not delay the first scans."""

import math

import numpy as np

from planar import Pose2, Scan
from slam_lite.config import MapperSettings
from slam_lite.mapper import Mapper

_RADIUS = 3.0


def warm_up(matcher_plugin: str = "") -> None:
    """Map a small simulated room, so that each kernel runs once.

    Args:
        matcher_plugin: Custom scan matcher to run as well.

    Raises:
        MatchingError: The custom matcher fails.
    """
    mapper = Mapper(MapperSettings(closure_min_detour=1.0, matcher_plugin=matcher_plugin))
    angles = np.linspace(-math.pi, math.pi, 181)
    for step in range(40):
        turn = 0.21 * step
        facing = angles + turn
        wall = _RADIUS / np.maximum(np.abs(np.cos(facing)), np.abs(np.sin(facing)))
        scan = Scan(float(step), angles[0], angles[1] - angles[0], wall.astype(np.float32), 0.1, 10.0)
        mapper.insert(Pose2(0.0, 0.0, turn), scan)
    mapper.run_final_optimization()
    mapper.grid()
