"""A robot without physics for node tests: tests set its pose, and it scans a map of two rooms."""

import math

import numpy as np
import rospy

from planar import OccupancyGrid as Grid
from planar import Pose2, grid_from_picture
from planar.geometry.ray_casting import cast_rays
from planar_ros.messages.conversion import GetMapArrays, LaserScanArrays, grid_to_msg
from planar_ros.messages.transforms import Transforms

ROOM = """
####################
#........#.........#
#........#.........#
#..................#
#..................#
#........#...###...#
#........#...###...#
#........#.........#
####################
"""
BEAMS = 360
RANGE_MAX = 8.0


def room(resolution=0.05, cell_size=0.4) -> Grid:
    """Map of two rooms, 8 x 3.6 m, with its lower left corner at (0, 0)."""
    cells = grid_from_picture(ROOM, resolution).cells
    times = round(cell_size / resolution)
    return Grid(np.kron(cells, np.ones((times, times), dtype=np.int8)), resolution)


class SimpleRobot:
    """Publishes odometry, starting at (0, 0, 0), and laser scans of a robot moved by ``move``."""

    def __init__(self, base_in_map: Pose2, laser_frame="laser", base_frame="base_link"):
        self.base_in_map = base_in_map
        self.base_in_odom = Pose2()
        self.grid = room()
        self.laser_frame, self.base_frame = laser_frame, base_frame
        self.transforms = Transforms()
        self._rng = np.random.default_rng(0)
        self._scans = rospy.Publisher("scan", LaserScanArrays, queue_size=10, tcp_nodelay=True)
        self.map_message = grid_to_msg(self.grid, rospy.Time.now(), "map")
        rospy.Service("static_map", GetMapArrays, lambda request: {"map": self.map_message})

    def move(self, step: Pose2, slip: Pose2 = Pose2()):
        """Move by ``step``; odometry has the error ``slip``."""
        self.base_in_map = self.base_in_map @ step
        self.base_in_odom = self.base_in_odom @ step @ slip

    def ranges(self) -> np.ndarray:
        angles = -math.pi + np.arange(BEAMS) * 2.0 * math.pi / BEAMS
        true = cast_rays(self.grid, self.base_in_map, angles, RANGE_MAX)
        return (true + self._rng.normal(0.0, 0.01, BEAMS)).astype(np.float32)

    def sense(self, ranges=None, stamp=None, tf_late=0.0, changed=None) -> rospy.Time:
        """Publish odometry and a scan with one stamp and return it; ``changed``: fields of the scan."""
        stamp = stamp or rospy.Time.now()
        scan = LaserScanArrays()
        scan.header.stamp, scan.header.frame_id = stamp, self.laser_frame
        scan.angle_min, scan.angle_max = -math.pi, math.pi
        scan.angle_increment = 2.0 * math.pi / BEAMS
        scan.range_min, scan.range_max = 0.1, RANGE_MAX
        scan.ranges = self.ranges() if ranges is None else ranges
        scan.intensities = np.zeros(0, dtype=np.float32)
        for name, value in (changed or {}).items():
            setattr(scan, name, value)
        if tf_late:
            self._scans.publish(scan)
            rospy.sleep(tf_late)
        self.transforms.send(Pose2(), self.base_frame, self.laser_frame, stamp)
        self.transforms.send(self.base_in_odom, "odom", self.base_frame, stamp)
        if not tf_late:
            self._scans.publish(scan)
        return stamp
