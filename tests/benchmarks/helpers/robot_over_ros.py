"""A simulated robot with ROS topics for any move_base node, and the node itself."""

import contextlib
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, Iterator, Mapping, Optional

import actionlib
import numpy as np
import rospy
import yaml
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import OccupancyGrid as OccupancyGridMsg
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from roslib.packages import find_node
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage
from tf2_ros import StaticTransformBroadcaster

from helpers.lockstep import Master
from move_base_lite.parameters import merged
from planar import OccupancyGrid, Pose2, Twist2
from planar_ros.calls.actions import server_is_ready
from planar_ros.messages.conversion import LaserScanArrays, grid_to_msg, pose2_to_msg, transform_msg
from sim_bridge import Episode, Simulation

START_SECONDS = 60.0
SETTLING_SECONDS = 1.0


@contextlib.contextmanager
def move_base(options, overrides: Mapping[str, Any] = {}) -> Iterator[subprocess.Popen]:
    """Run a master and ``options.node`` with the parameters of ``options.config`` and ``overrides``."""
    with contextlib.closing(Master(options.port)):
        node = _start_node(options, overrides)
        try:
            yield node
        finally:
            node.terminate()
            node.wait()


def _start_node(options, overrides: Mapping[str, Any]) -> subprocess.Popen:
    parameters = merged(yaml.safe_load(Path(options.config).read_text(encoding="utf-8")), overrides)
    parameters.setdefault("DWAPlannerROS", {})["global_frame_id"] = "odom"
    if options.local_planner:
        parameters["base_local_planner"] = options.local_planner
    rospy.set_param("/move_base", parameters)
    package, executable = options.node.split("/")
    path = find_node(package, executable)
    if not path:
        raise SystemExit(f"no node {options.node} is installed")
    return subprocess.Popen([path[0], "__name:=move_base"], stdout=sys.stderr)


def add_node_options(parser, config: Optional[Path]) -> None:
    """Parse the options that select the navigation node and the speed."""
    parser.add_argument("--node", default="move_base_lite/move_base_lite", help="package/executable")
    parser.add_argument("--config", default=config, help="parameters of move_base")
    parser.add_argument("--local-planner", help="base_local_planner instead of that of the parameters")
    parser.add_argument("--speed", type=float, default=1.0, help="simulated seconds a second")
    parser.add_argument("--port", type=int, default=11411, help="of the ROS master that is started")


class RobotOverRos:
    """A simulation that publishes clock, tf, odom and scan and subscribes to cmd_vel, paced by wall time."""

    def __init__(self, speed: float, grid: Optional[OccupancyGrid] = None):
        self._speed = speed
        self._clock = rospy.Publisher("/clock", Clock, queue_size=10, tcp_nodelay=True)
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=10, tcp_nodelay=True)
        self._odom = rospy.Publisher("odom", Odometry, queue_size=10, tcp_nodelay=True)
        self._scan = rospy.Publisher("scan", LaserScanArrays, queue_size=10, tcp_nodelay=True)
        self._static = StaticTransformBroadcaster()
        self._command: Optional[Twist2] = None
        rospy.Subscriber("cmd_vel", Twist, self._on_command, queue_size=1, tcp_nodelay=True)
        if grid is not None:
            self._map = rospy.Publisher("map", OccupancyGridMsg, queue_size=1, latch=True)
            self._map.publish(grid_to_msg(grid, rospy.Time(0), "map"))
        self._time_offset = 0.0

    def switch_simulation(self, simulation: Simulation) -> None:
        """Continue with another simulation, whose time follows that of the previous one."""
        self._time_offset = self.now if self._time_offset else SETTLING_SECONDS
        self._simulation, self._command = simulation, None
        self._episode = Episode(simulation, simulation.step_seconds)
        self._wall = time.monotonic()
        self.step()
        while self.observation.scan is None:
            self.step()
        laser = self.observation.scan.laser_in_base
        stamp = rospy.Time.from_sec(self.now)
        self._static.sendTransform(transform_msg(laser, "base_footprint", "laser", stamp))

    @property
    def now(self) -> float:
        return self._time_offset + self.observation.stamp

    def step_for(self, seconds: float) -> None:
        """Step for a simulated time [s]."""
        for _ in range(round(seconds / self._simulation.step_seconds)):
            self.step()

    def step(self) -> None:
        """Step by one period of the odometry."""
        command, self._command = self._command, None
        self.observation = step_result = self._episode.step(command)
        stamp = rospy.Time.from_sec(self.now)
        odometry = step_result.odometry
        odom_in_map = step_result.base_in_world @ odometry.base_in_odom.inverse()
        self._tf.publish(
            [
                transform_msg(odom_in_map, "map", "odom", stamp + rospy.Duration(0.1)),
                transform_msg(odometry.base_in_odom, "odom", "base_footprint", stamp),
            ]
        )
        message = Odometry()
        message.header.stamp, message.header.frame_id = stamp, "odom"
        message.child_frame_id = "base_footprint"
        message.pose.pose = pose2_to_msg(odometry.base_in_odom)
        message.twist.twist.linear.x = odometry.twist.v
        message.twist.twist.angular.z = odometry.twist.omega
        self._odom.publish(message)
        if step_result.scan is not None:
            self._publish_scan(step_result.scan, stamp)
        self._clock.publish(Clock(stamp))
        self._wall += self._simulation.step_seconds / self._speed
        time.sleep(max(0.0, self._wall - time.monotonic()))

    def _publish_scan(self, scan, stamp):
        message = LaserScanArrays()
        message.header.stamp, message.header.frame_id = stamp, "laser"
        message.angle_min, message.angle_increment = scan.angle_min, scan.angle_increment
        message.angle_max = scan.angle_min + scan.angle_increment * (len(scan.ranges) - 1)
        message.range_min, message.range_max = scan.range_min, scan.range_max
        message.ranges, message.intensities = scan.ranges, np.empty(0, dtype=np.float32)
        self._scan.publish(message)

    def _on_command(self, message):
        self._command = Twist2(message.linear.x, message.angular.z)


def client_with_goal(robot: RobotOverRos, frame: str, goal: Pose2) -> actionlib.SimpleActionClient:
    """Send the goal to a node whose costmaps are cleared. Exits if the node does not start."""
    client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
    until = time.monotonic() + START_SECONDS
    while not server_is_ready(client):
        robot.step()
        if time.monotonic() > until:
            raise SystemExit("the node does not start")
    robot.step_for(SETTLING_SECONDS)
    rospy.ServiceProxy("move_base/clear_costmaps", Empty)()
    robot.step_for(SETTLING_SECONDS)
    pose = PoseStamped(pose=pose2_to_msg(goal))
    pose.header.frame_id = frame
    client.send_goal(MoveBaseGoal(pose))
    return client


def is_active(client: actionlib.SimpleActionClient) -> bool:
    return client.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE)
