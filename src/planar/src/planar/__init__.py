"""Planar geometry shared by every package: poses, grids, scans, ray casting, distance fields, map files.

Pure: numpy, scipy and numba only. Lengths are metres, angles radians (REP 103); poses are named
``<what>_in_<frame>`` so that the inner names of a product meet::

    odom_in_map = base_in_map @ base_in_odom.inverse()
"""

from planar.errors import PlanarError, SettingsError
from planar.files.writing import FileWriteError, write_atomically
from planar.geometry.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, grid_from_picture
from planar.geometry.pose import Pose2, Twist2, wrap
from planar.geometry.scan import Scan
from planar.maps.map_file import MapFileError, load_map, save_map

__all__ = [
    "FREE",
    "OCCUPIED",
    "UNKNOWN",
    "FileWriteError",
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
