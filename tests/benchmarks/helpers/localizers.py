"""Localization nodes behind one interface: amcl and amcl_lite, and als_ros with its custom topics."""

import math
import subprocess
import threading
import time
from pathlib import Path
from typing import Any, Dict, Optional, Tuple

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, Vector3Stamped
from nav_msgs.msg import OccupancyGrid as OccupancyGridMsg
from nav_msgs.msg import Odometry
from std_msgs.msg import Float32

from helpers.drives import Observation
from helpers.localization_cases import FRAMES
from helpers.lockstep import ANSWER_SECONDS, START_SECONDS, Node, Player
from planar import OccupancyGrid, Pose2
from planar_ros.messages.conversion import grid_to_msg, pose2_to_msg, yaw_of

# Parameters of als_ros's mcl.launch that differ from those of its program, and the frames of the player.
ALS_ROS: Dict[str, Any] = {
    "base_link_frame": "base_footprint",
    "measurement_model_type": 2,
    "particle_num": 1000,
    "scan_step": 5,
    "var_hit": 0.08,
    "lambda_short": 1.0,
    "lambda_unknown": 0.01,
    "alpha_fast": 0.99,
    "initial_noise_yaw": 0.01,
    "random_particles_noise": [0.05, 0.05, 0.1],
    "odom_noise_ddm": [1.0, 0.5, 0.5, 1.5],
    "resample_thresholds": [0.2, 0.2, 0.2, 0.02, -99999.0],
    "transform_tolerance": 0.0,
}
# Wall seconds within which messages on one topic arrive before those published on another one afterwards.
_DELIVERED = 0.015


class _Localizer:
    """What is alike for all nodes."""

    _player: Player
    _node: Node

    def set_pose(self, base_in_map: Pose2) -> None:
        """State where the robot is, as in RViz."""
        self._player.set_pose(base_in_map)

    def cpu_seconds(self) -> float:
        """CPU time so far."""
        return self._node.cpu_seconds()


class Amcl(_Localizer):
    """A node with amcl's interface; the quality of amcl is minus its standard deviation."""

    def __init__(self, player: Player, command: str, start: Pose2, seed: int):
        initial = {f"initial_pose_{axis}": value for axis, value in zip("xya", start.as_array().tolist())}
        self._player, self._odom_in_map, self._quality = player, Pose2(), math.nan
        self._subscribers = [
            rospy.Subscriber("amcl/localization_quality", Float32, self._on_quality),
            rospy.Subscriber("amcl_pose", PoseWithCovarianceStamped, self._on_covariance),
        ]
        self._has_quality = False
        self._node = player.start_node([command], {**FRAMES, **initial, "seed": seed})

    def wake(self, observation: Observation) -> None:
        """Show an observation until the node answers."""
        self._player.wake(observation)

    def show(self, observation: Observation, period: float) -> Tuple[Pose2, float]:
        """Return the estimate of the base's pose after an observation, and its quality."""
        self._odom_in_map = self._player.show(observation, period=period) or self._odom_in_map
        return self._odom_in_map @ observation.base_in_odom, self._quality

    def close(self) -> None:
        """End the node."""
        self._node.close()
        for subscriber in self._subscribers:
            subscriber.unregister()

    def _on_quality(self, message: Float32) -> None:
        self._quality, self._has_quality = message.data, True

    def _on_covariance(self, message: PoseWithCovarianceStamped) -> None:
        if not self._has_quality:
            self._quality = -math.sqrt(message.pose.covariance[0] + message.pose.covariance[7])


class AlsRos(_Localizer):
    """The node mcl of als_ros with its reliability, which integrates the speeds of nav_msgs/Odometry."""

    def __init__(self, player: Player, program: Path, grid: OccupancyGrid, start: Pose2):
        initial = {"x": start.x, "y": start.y, "yaw": math.degrees(start.yaw)}
        classifier = program.parents[3] / "src" / "als_ros" / "classifiers" / "MAE"
        parameters = {**ALS_ROS, **{f"initial_pose_{name}": value for name, value in initial.items()}}
        for name, value in {**parameters, "mae_classifier_dir": f"{classifier}/"}.items():
            rospy.set_param("/mcl/" + name, value)
        self._player, self._estimate = player, start
        self._last: Optional[Pose2] = None
        self._quality = math.nan
        self._answers: Dict[int, Pose2] = {}
        self._reliabilities: Dict[int, float] = {}
        self._has_answer = threading.Condition()
        self._map = rospy.Publisher("/map", OccupancyGridMsg, queue_size=1, latch=True)
        self._map.publish(_map_message(grid))
        self._odometry = rospy.Publisher("/odom", Odometry, queue_size=10, tcp_nodelay=True)
        self._subscribers = [
            rospy.Subscriber("/mcl_pose", PoseStamped, self._on_pose, tcp_nodelay=True),
            rospy.Subscriber("/reliability", Vector3Stamped, self._on_reliability, tcp_nodelay=True),
        ]
        self._node = Node([str(program), "__name:=mcl"])

    def wake(self, observation: Observation) -> None:
        """Show an observation until the node answers."""
        deadline = time.monotonic() + START_SECONDS
        while self._answer(observation, 0.1, 0.3) is None:
            if time.monotonic() > deadline:
                raise RuntimeError("the node does not answer")

    def show(self, observation: Observation, period: float) -> Tuple[Pose2, float]:
        """Return the estimate of the base's pose after an observation, and its quality."""
        self._estimate = self._answer(observation, period, ANSWER_SECONDS) or self._estimate
        return self._estimate, self._quality

    def close(self) -> None:
        """End the node."""
        self._node.close()
        for endpoint in (*self._subscribers, self._map, self._odometry):
            endpoint.unregister()

    def _answer(self, observation: Observation, period: float, patience: float) -> Optional[Pose2]:
        """Publish an observation, and let the node's loop run once."""
        stamp = self._player.advance(period)
        self._odometry.publish(self._odometry_message(observation.base_in_odom, stamp, period))
        time.sleep(_DELIVERED)
        self._player.publish_scan(observation.scan, stamp)
        time.sleep(_DELIVERED)
        self._player.tick()
        key = stamp.to_nsec()
        with self._has_answer:
            self._has_answer.wait_for(lambda: key in self._answers and key in self._reliabilities, patience)
            self._quality = self._reliabilities.pop(key, self._quality)
            return self._answers.pop(key, None)

    def _odometry_message(self, base_in_odom: Pose2, stamp: rospy.Time, period: float) -> Odometry:
        """The pose, and the speeds that lead to it from the last one, along the heading in between."""
        motion = (self._last or base_in_odom).inverse() @ base_in_odom
        self._last = base_in_odom
        message = Odometry()
        message.header.stamp, message.header.frame_id = stamp, "odom"
        message.pose.pose = pose2_to_msg(base_in_odom)
        c, s = math.cos(0.5 * motion.yaw), math.sin(0.5 * motion.yaw)
        message.twist.twist.linear.x = (c * motion.x + s * motion.y) / period
        message.twist.twist.angular.z = motion.yaw / period
        return message

    def _on_pose(self, message: PoseStamped) -> None:
        position = message.pose.position
        with self._has_answer:
            pose = Pose2(position.x, position.y, yaw_of(message.pose.orientation))
            self._answers[message.header.stamp.to_nsec()] = pose
            self._has_answer.notify_all()

    def _on_reliability(self, message: Vector3Stamped) -> None:
        with self._has_answer:
            self._reliabilities[message.header.stamp.to_nsec()] = message.vector.x
            self._has_answer.notify_all()


def als_ros_program() -> Optional[Path]:
    """The program mcl of als_ros; None if it is not installed."""
    found = subprocess.run(["catkin_find", "als_ros", "mcl"], stdout=subprocess.PIPE, check=False)
    programs = [Path(line) for line in found.stdout.decode().split()]
    return next((program for program in programs if program.is_file()), None)


def _map_message(grid: OccupancyGrid) -> OccupancyGridMsg:
    """A map that rospy's own message class can serialize."""
    arrays, message = grid_to_msg(grid, rospy.Time(1), "map"), OccupancyGridMsg()
    message.header, message.info = arrays.header, arrays.info
    message.data = np.asarray(arrays.data).astype(np.int8).tolist()
    return message
