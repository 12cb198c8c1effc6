"""A kinematic robot for tests of move_base: publishes clock, map, transforms and sensors.

Time advances as fast as the node under test keeps up. A test can switch off each output.
"""

import math
import threading
import time

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid as OccupancyGridMsg
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from sensor_msgs.point_cloud2 import create_cloud_xyz32
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from planar import OccupancyGrid, Pose2, grid_from_picture
from planar.geometry.ray_casting import cast_rays
from planar_ros.lockstep.ticker import PROGRESS_TOPIC
from planar_ros.messages.conversion import LaserScanArrays, grid_to_msg, pose2_to_msg, transform_msg

ROOMS = """
################
#......##......#
#......##......#
#......##......#
#..............#
#..............#
#......##......#
#......##......#
#......##......#
################
"""
CELL_METRES, RESOLUTION = 0.4, 0.05
STEP, LEAD = 0.05, 0.1
# Highest real-time factor: the delivery of messages takes simulated time.
MAX_REAL_TIME_FACTOR = 5.0
# Wall seconds after which time advances without the node.
PATIENCE = 1.0
BEAMS, RANGE_MAX, STEPS_PER_SCAN = 360, 8.0, 2


def rooms() -> OccupancyGrid:
    """Two rooms side by side, 6.4 x 4 m, with a door of 0.8 m; the lower left corner is the origin."""
    times = round(CELL_METRES / RESOLUTION)
    cells = grid_from_picture(ROOMS, RESOLUTION).cells
    return OccupancyGrid(np.kron(cells, np.ones((times, times), np.int8)), RESOLUTION)


class FakeRobot:
    """The robot starts at (1, 2) in the map and in the odometry frame."""

    def __init__(self):
        self.grid = rooms()
        self.base_in_odom, self.odom_in_map = Pose2(1.0, 2.0), Pose2()
        self.twist = Twist()
        self.has_localization = self.has_odometry = self.has_scan = True
        self.scan_frame = "laser"
        self.spoil = lambda ranges: ranges
        self.cloud_xyz = None
        self.now, self._steps = 100.0, 0
        self._reached, self._has_progress = 0.0, threading.Event()
        self._clock = rospy.Publisher("/clock", Clock, queue_size=10, tcp_nodelay=True)
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=10, tcp_nodelay=True)
        self._odom = rospy.Publisher("odom", Odometry, queue_size=10, tcp_nodelay=True)
        self._scan = rospy.Publisher("scan", LaserScanArrays, queue_size=10, tcp_nodelay=True)
        self._cloud = rospy.Publisher("cloud", PointCloud2, queue_size=10, tcp_nodelay=True)
        self._map = rospy.Publisher("map", OccupancyGridMsg, queue_size=1, latch=True)
        rospy.Subscriber("cmd_vel", Twist, self._on_command, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber(PROGRESS_TOPIC, Header, self._on_progress, queue_size=10, tcp_nodelay=True)
        threading.Thread(target=self._run, daemon=True).start()

    @property
    def base_in_map(self) -> Pose2:
        return self.odom_in_map @ self.base_in_odom

    def show_map(self):
        self._map.publish(grid_to_msg(self.grid, rospy.Time(0), "map"))

    def _run(self):
        while not rospy.is_shutdown():
            self._move()
            self._publish()
            until = time.monotonic() + PATIENCE
            while self._reached < self.now - LEAD and time.monotonic() < until:
                self._has_progress.wait(0.02)
                self._has_progress.clear()
            time.sleep(STEP / MAX_REAL_TIME_FACTOR)

    def _move(self):
        self.now += STEP
        v, omega = self.twist.linear.x, self.twist.angular.z
        self.base_in_odom = self.base_in_odom @ Pose2(
            v * STEP * math.cos(omega * STEP / 2), v * STEP * math.sin(omega * STEP / 2), omega * STEP
        )

    def _publish(self):
        stamp = rospy.Time.from_sec(round(self.now, 3))
        transforms = [transform_msg(Pose2(), "base_footprint", "laser", stamp)]
        if self.has_odometry:
            transforms.append(transform_msg(self.base_in_odom, "odom", "base_footprint", stamp))
        if self.has_localization:
            transforms.append(transform_msg(self.odom_in_map, "map", "odom", stamp))
        self._tf.publish(transforms)
        odometry = Odometry(header=Header(stamp=stamp, frame_id="odom"), child_frame_id="base_footprint")
        odometry.pose.pose, odometry.twist.twist = pose2_to_msg(self.base_in_odom), self.twist
        self._odom.publish(odometry)
        self._steps += 1
        if self.has_scan and self._steps % STEPS_PER_SCAN == 0:
            self._publish_scan(stamp)
        if self.cloud_xyz is not None:
            header = Header(stamp=stamp, frame_id="base_footprint")
            self._cloud.publish(create_cloud_xyz32(header, self.cloud_xyz))
        self._clock.publish(Clock(stamp))

    def _publish_scan(self, stamp):
        angles = -math.pi + 2.0 * math.pi / BEAMS * np.arange(BEAMS)
        message = LaserScanArrays()
        message.header.stamp, message.header.frame_id = stamp, self.scan_frame
        message.angle_min, message.angle_increment = -math.pi, 2.0 * math.pi / BEAMS
        message.range_min, message.range_max = 0.1, RANGE_MAX
        seen = cast_rays(self.grid, self.base_in_map, angles, RANGE_MAX).astype(np.float32)
        message.ranges = self.spoil(seen)
        message.intensities = np.empty(0, np.float32)
        self._scan.publish(message)

    def _on_command(self, message):
        self.twist = message

    def _on_progress(self, message):
        self._reached = message.stamp.to_sec()
        self._has_progress.set()
