"""Compiled kernels before they are needed."""

from explorer_lite.explorer import Explorer
from planar import Pose2, grid_from_picture


def warm_up() -> None:
    """Compiles, or loads from the cache, every kernel that the explorer uses."""
    grid = grid_from_picture("?.....\n......\n......", resolution=0.5)
    Explorer().advance(0.0, grid, Pose2(1.0, 0.75))
