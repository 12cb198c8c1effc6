"""Plays drives to a localization node, scan by scan, and takes down what it answers and what that costs."""

import os
import subprocess
import threading
import time
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence

import numpy as np
import psutil
import rosgraph
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage
from tf2_ros import StaticTransformBroadcaster

from helpers.drives import Observation
from planar import OccupancyGrid, Pose2, Scan
from planar_ros.messages.conversion import (
    GetMapArrays,
    LaserScanArrays,
    grid_to_msg,
    pose2_to_msg,
    transform_msg,
    yaw_of,
)

TOLERANCE = 0.1
# How long, wall seconds, a node may take to answer a scan before the scan counts as unanswered.
ANSWER_SECONDS = 3.0
# A node may take this long to start, wall seconds.
START_SECONDS = 120.0


class Master:
    """Start a ROS master with simulated time and make this process a node of it."""

    def __init__(self, port: int):
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
        self._process = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL)
        while not rosgraph.is_master_online():
            time.sleep(0.1)
        rospy.set_param("/use_sim_time", True)
        rospy.init_node("player", disable_signals=True)

    def close(self):
        rospy.signal_shutdown("done")
        self._process.terminate()
        self._process.wait()


class Player:
    """Publishes clock, odometry and scans; knows when map -> odom has come back for a scan."""

    def __init__(self, grid: OccupancyGrid, laser_in_base: Pose2):
        self._now = 100.0
        self._clock = rospy.Publisher("/clock", Clock, queue_size=10, tcp_nodelay=True)
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=10, tcp_nodelay=True)
        self._scans = rospy.Publisher("scan", LaserScanArrays, queue_size=10, tcp_nodelay=True)
        self._initial_pose = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=2)
        self._static = StaticTransformBroadcaster()
        self._answers: Dict[int, Pose2] = {}
        self._has_answer = threading.Condition()
        static = transform_msg(laser_in_base, "base_footprint", "laser", rospy.Time(1))
        self._static.sendTransform(static)
        rospy.Subscriber("/tf", TFMessage, self._on_tf, tcp_nodelay=True)
        self._map_service = rospy.Service("static_map", GetMapArrays, lambda request: {"map": self._map})
        self.use_map(grid)

    def use_map(self, grid: OccupancyGrid) -> None:
        self._map = grid_to_msg(grid, rospy.Time(1), "map")

    def start_node(self, command: Sequence[str], parameters: Dict[str, Any]) -> "Node":
        """Starts a localization node named amcl and waits until it answers."""
        if rospy.has_param("/amcl"):
            rospy.delete_param("/amcl")
        for name, value in {**parameters, "transform_tolerance": TOLERANCE}.items():
            rospy.set_param("/amcl/" + name, value)
        node = Node([*command, "__name:=amcl"])
        self.tick()
        rospy.wait_for_service("global_localization", START_SECONDS)
        while self._scans.get_num_connections() == 0:
            time.sleep(0.05)
        return node

    def wake(self, observation: Observation) -> None:
        """Shows the node a scan until it answers for the first time."""
        deadline = time.monotonic() + START_SECONDS
        while time.monotonic() < deadline:
            if self.show(observation, patience=0.5) is not None:
                return
        raise RuntimeError("the node does not answer")

    def show(
        self, observation: Observation, patience: float = ANSWER_SECONDS, period: float = 0.1
    ) -> Optional[Pose2]:
        """Publish an observation, ``period`` after the last one.

        Returns:
            Odometry frame in the map; None without an answer.
        """
        stamp = self.advance(period)
        key = (stamp + rospy.Duration(TOLERANCE)).to_nsec()
        self.tick()
        base = transform_msg(observation.base_in_odom, "odom", "base_footprint", stamp)
        self._tf.publish(TFMessage([base]))
        self.publish_scan(observation.scan, stamp)
        with self._has_answer:
            self._has_answer.wait_for(lambda: key in self._answers, patience)
            return self._answers.pop(key, None)

    def advance(self, period: float) -> rospy.Time:
        """Advance the time, without publishing it, and return it."""
        self._now += period
        return rospy.Time.from_sec(round(self._now, 3))

    def publish_scan(self, scan: Scan, stamp: rospy.Time) -> None:
        self._scans.publish(_scan_message(scan, stamp))

    def tick(self) -> None:
        """Publish the time."""
        self._clock.publish(Clock(rospy.Time.from_sec(round(self._now, 3))))

    def set_pose(self, base_in_map: Pose2, variances=(0.25, 0.25, 0.0685)) -> None:
        message = PoseWithCovarianceStamped()
        message.header.frame_id = "map"
        message.header.stamp = rospy.Time.from_sec(round(self._now, 3))
        message.pose.pose = pose2_to_msg(base_in_map)
        covariance = np.zeros((6, 6))
        covariance[(0, 1, 5), (0, 1, 5)] = variances
        message.pose.covariance = covariance.ravel().tolist()
        self._initial_pose.publish(message)
        time.sleep(0.3)

    def localize_globally(self) -> None:
        rospy.ServiceProxy("global_localization", Empty)()

    def _on_tf(self, message):
        for transform in message.transforms:
            if transform.child_frame_id == "odom":
                moved, turned = transform.transform.translation, yaw_of(transform.transform.rotation)
                with self._has_answer:
                    key = transform.header.stamp.to_nsec()
                    self._answers[key] = Pose2(moved.x, moved.y, turned)
                    self._has_answer.notify_all()


class Node:
    """A running process."""

    def __init__(self, command: List[str], environment: Optional[Mapping[str, str]] = None):
        self._process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment
        )

    def wait(self, seconds: float) -> int:
        """Waits for its end; returns its exit code. Raises subprocess.TimeoutExpired."""
        return self._process.wait(seconds)

    def cpu_seconds(self) -> float:
        """CPU time used so far by all threads, to the nanosecond."""
        tasks = Path(f"/proc/{self._process.pid}/task").glob("*/schedstat")
        return sum(int(task.read_text().split()[0]) for task in tasks) * 1e-9

    def resident_megabytes(self) -> float:
        return psutil.Process(self._process.pid).memory_info().rss / 2**20

    def close(self):
        self._process.terminate()
        try:
            self._process.wait(10.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def _scan_message(scan, stamp):
    message = LaserScanArrays()
    message.header.stamp, message.header.frame_id = stamp, "laser"
    message.angle_min, message.angle_increment = scan.angle_min, scan.angle_increment
    message.angle_max = scan.angle_min + (len(scan.ranges) - 1) * scan.angle_increment
    message.range_min, message.range_max = scan.range_min, scan.range_max
    message.ranges = np.asarray(scan.ranges, dtype=np.float32)
    message.intensities = np.zeros(0, dtype=np.float32)
    return message
