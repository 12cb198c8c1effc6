"""Plane geometry, grids, scans, map files and settings shared by every package.

Depends on numpy, scipy and numba only, not on ROS. Lengths are metres, angles radians (REP 103). A pose is
named ``<what>_in_<frame>``, so that the inner names of a product match::

    odom_in_map = base_in_map @ base_in_odom.inverse()
"""

from typing import TYPE_CHECKING

from planar.lazy_names import lazy_names

if TYPE_CHECKING:
    from planar.errors import FileWriteError, PlanarError, SettingsError
    from planar.files.writing import write_atomically
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

__getattr__ = lazy_names(
    __name__,
    {
        "planar.errors": ("FileWriteError", "PlanarError", "SettingsError"),
        "planar.files.writing": ("write_atomically",),
        "planar.geometry.grid": ("FREE", "OCCUPIED", "UNKNOWN", "OccupancyGrid", "grid_from_picture"),
        "planar.geometry.pose": ("Pose2", "Twist2", "wrap"),
        "planar.geometry.scan": ("Scan",),
        "planar.maps.map_file": ("MapFileError", "load_map", "save_map"),
    },
)
