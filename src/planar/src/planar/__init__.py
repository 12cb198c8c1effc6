"""Planar geometry shared by every package: poses, grids, scans, ray casting, distance fields, map files.

Pure: numpy, scipy and numba only. Lengths are metres, angles radians (REP 103); poses are named
``<what>_in_<frame>`` so that the inner names of a product meet::

    odom_in_map = base_in_map @ base_in_odom.inverse()
"""

from planar.errors import PlanarError, SettingsError
from planar.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, grid_from_picture
from planar.map_file import MapFileError, load_map, save_map, write_atomically
from planar.pose import Pose2, Twist2, wrap
from planar.scan import Scan

__all__ = [
    "FREE",
    "OCCUPIED",
    "UNKNOWN",
    "MapFileError",
    "OccupancyGrid",
    "PlanarError",
    "Pose2",
    "Scan",
    "SettingsError",
    "Twist2",
    "grid_from_picture",
    "load_map",
    "save_map",
    "wrap",
    "write_atomically",
]
