"""Plays bags to a localization node scan by scan, waiting for the transform after each scan."""

import subprocess
import threading
import time
from typing import Callable, Dict, Optional

import rosbag
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

from planar import OccupancyGrid, Pose2
from planar_ros.messages.conversion import (
    GetMapArrays,
    grid_to_msg,
    pose2_from_msg,
    pose2_to_msg,
    time_of,
    yaw_of,
)

TOLERANCE = 0.1
START_SECONDS, RUN_SECONDS = 30.0, 60.0
# Longest wall-clock wait for the transform after a scan [s], and most scans in a row without one.
GRACE_SECONDS, MOST_UNANSWERED = 0.5, 20
# Variances of an initial pose [m^2, m^2, rad^2].
INITIAL_VARIANCES = (0.25, 0.25, 0.0685)


class BagEnvironment:
    """Map, clock, transforms and scans for one localization node named ``amcl`` at a time."""

    def __init__(self, package: str):
        self._package = package
        self._process: Optional[subprocess.Popen] = None
        self._map = None
        self._now = rospy.Time(0)
        self._answers: Dict[int, Pose2] = {}
        self._has_answer = threading.Condition()
        self._clock = rospy.Publisher("/clock", Clock, queue_size=10, tcp_nodelay=True)
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=100, tcp_nodelay=True)
        self._static = rospy.Publisher("/tf_static", TFMessage, queue_size=10, latch=True)
        self._scans = rospy.Publisher("scan", LaserScan, queue_size=10, tcp_nodelay=True)
        self._initial_pose = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=2)
        rospy.Subscriber("/tf", TFMessage, self._on_tf, tcp_nodelay=True)
        self._service = rospy.Service("static_map", GetMapArrays, lambda request: {"map": self._map})

    def start_node(self, grid: OccupancyGrid, parameters: Dict[str, object]):
        """Start the node with exactly these parameters."""
        self.stop_node()
        self._process = subprocess.Popen(self._command(grid, parameters))

    def run_node(self, grid: OccupancyGrid, parameters: Dict[str, object], *arguments: str) -> str:
        """Run the node with command line ``arguments`` to its end; return its output."""
        self.stop_node()
        command = [*self._command(grid, parameters), *arguments]
        done = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=RUN_SECONDS, check=True
        )
        return done.stdout.decode()

    def _command(self, grid, parameters):
        self._map = grid_to_msg(grid, rospy.Time(1), "map")
        if rospy.has_param("/amcl"):
            rospy.delete_param("/amcl")
        for name, value in {**parameters, "transform_tolerance": TOLERANCE}.items():
            rospy.set_param("/amcl/" + name, value)
        return ["rosrun", self._package, self._package, "__name:=amcl"]

    def stop_node(self):
        if self._process is not None:
            self._process.terminate()
            self._process.wait()
            self._process = None
            while self._scans.get_num_connections() > 0:
                time.sleep(0.05)

    def play(self, bag_path: str, actions: Dict[float, Callable[[rospy.Time], None]] = {}) -> "FinalPoses":
        """Play a bag; ``actions`` are called at times since its start [s]. Return the last poses."""
        with rosbag.Bag(bag_path) as bag:
            start = bag.get_start_time()
            self._wait_for_node(time_of(start))
            due = sorted(actions)
            base_in_odom, truth, found, unanswered = Pose2(), Pose2(), None, 0
            for topic, message, stamp in bag.read_messages():
                self._now = stamp
                self._clock.publish(stamp)
                while due and due[0] <= stamp.to_sec() - start:
                    actions[due.pop(0)](stamp)
                if topic == "/tf_static":
                    self._static.publish(message)
                elif topic == "/tf":
                    base_in_odom = _pose_of(message.transforms[0])
                    self._tf.publish(message)
                elif topic == "/scan":
                    self._scans.publish(message)
                    odom_in_map = self._answer_to(stamp, GRACE_SECONDS)
                    unanswered = unanswered + 1 if odom_in_map is None else 0
                    if unanswered > MOST_UNANSWERED:
                        raise AssertionError(f"{unanswered} scans without a transform")
                    if odom_in_map is not None:
                        found = odom_in_map @ base_in_odom
                else:
                    truth = pose2_from_msg(message.pose.pose)
        return FinalPoses(found, truth)

    def advance_clock(self, seconds: float):
        """Advance simulated time after a bag, without scans."""
        self._now += rospy.Duration(seconds)
        self._clock.publish(self._now)

    def publish_initial_pose(self, base_in_map: Pose2, stamp: rospy.Time):
        message = PoseWithCovarianceStamped()
        message.header.frame_id, message.header.stamp = "map", stamp
        message.pose.pose = pose2_to_msg(base_in_map)
        covariance = [0.0] * 36
        covariance[0], covariance[7], covariance[35] = INITIAL_VARIANCES
        message.pose.covariance = covariance
        self._initial_pose.publish(message)
        time.sleep(GRACE_SECONDS)

    def localize_globally(self):
        rospy.ServiceProxy("global_localization", Empty)()

    def _wait_for_node(self, stamp):
        deadline = time.monotonic() + START_SECONDS
        publishers = (self._scans, self._static, self._initial_pose)
        # Two: this process subscribes to transforms too.
        while self._tf.get_num_connections() < 2 or not all(one.get_num_connections() for one in publishers):
            self._clock.publish(stamp)
            if time.monotonic() > deadline:
                raise AssertionError("the node has not subscribed to scans")
            time.sleep(0.05)

    def _answer_to(self, stamp, seconds) -> Optional[Pose2]:
        key = (stamp + rospy.Duration(TOLERANCE)).to_nsec()
        with self._has_answer:
            self._has_answer.wait_for(lambda: key in self._answers, seconds)
            return self._answers.pop(key, None)

    def _on_tf(self, message):
        for transform in message.transforms:
            if transform.child_frame_id == "odom":
                with self._has_answer:
                    self._answers[transform.header.stamp.to_nsec()] = _pose_of(transform)
                    self._has_answer.notify_all()


class FinalPoses:
    """Estimated and true pose at the end of a bag."""

    def __init__(self, found: Optional[Pose2], truth: Pose2):
        self.found, self.truth = found, truth


def _pose_of(transform) -> Pose2:
    moved = transform.transform
    return Pose2(moved.translation.x, moved.translation.y, yaw_of(moved.rotation))
