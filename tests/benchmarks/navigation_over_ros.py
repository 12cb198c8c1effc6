#!/usr/bin/env python3
"""Drives a simulated TurtleBot between random places of a home by any node that is a move_base.

The node gets drifting odometry, scans and, as from a perfect localization, the true map -> odom. The official
move_base is compared where it is installed:

    python3 tests/benchmarks/navigation_over_ros.py --pairs 20
    python3 tests/benchmarks/navigation_over_ros.py --pairs 20 --node move_base/move_base
"""

import argparse
import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import List

import actionlib
import numpy as np
import psutil
import rosgraph
import rospy
import yaml
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import OccupancyGrid as OccupancyGridMsg
from nav_msgs.msg import Odometry
from navigation import add_box, places
from rosgraph_msgs.msg import Clock
from roslib.packages import find_node
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage
from tf2_ros import StaticTransformBroadcaster

from move_base_lite import load_settings
from planar import Pose2, Twist2, load_map
from planar_ros.actions import server_is_ready
from planar_ros.messages import LaserScanArrays, grid_to_msg, pose2_to_msg, transform_msg
from sim_bridge import Simulation, load_world

ROOT = Path(__file__).resolve().parents[2]
CONFIG = ROOT / "src" / "move_base_lite" / "config" / "turtlebot.yaml"
START_SECONDS = 60.0
GAP = 1.0


@dataclass(frozen=True)
class Run:
    """One drive: simulated seconds, metres, CPU seconds of the node."""

    status: str
    seconds: float
    driven: float
    off_by: float
    touched: List[str]
    cpu_seconds: float


class RobotOverRos:
    """A Simulation that speaks ROS: clock, tf, odom and scan out, cmd_vel in; wall time paces it."""

    def __init__(self, grid, speed: float):
        self._speed = speed
        self._clock = rospy.Publisher("/clock", Clock, queue_size=10, tcp_nodelay=True)
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=10, tcp_nodelay=True)
        self._odom = rospy.Publisher("odom", Odometry, queue_size=10, tcp_nodelay=True)
        self._scan = rospy.Publisher("scan", LaserScanArrays, queue_size=10, tcp_nodelay=True)
        self._map = rospy.Publisher("map", OccupancyGridMsg, queue_size=1, latch=True)
        self._static = StaticTransformBroadcaster()
        self._command = None
        rospy.Subscriber("cmd_vel", Twist, self._on_command, queue_size=1, tcp_nodelay=True)
        self._map.publish(grid_to_msg(grid, rospy.Time(0), "map"))
        self._begun = 0.0

    def put(self, simulation: Simulation) -> None:
        """Goes on with another simulation; its time is added to what has passed."""
        self._begun = self.now if self._begun else GAP
        self._simulation, self._command = simulation, None
        self._wall = time.monotonic()
        self.step()
        while self.observation.scan is None:
            self.step()
        laser = self.observation.scan.laser_in_base
        stamp = rospy.Time.from_sec(self.now)
        self._static.sendTransform(transform_msg(laser, "base_footprint", "laser", stamp))

    @property
    def now(self) -> float:
        return self._begun + self.observation.stamp

    def step_for(self, seconds: float) -> None:
        """Moves on by so many seconds."""
        for _ in range(round(seconds / self._simulation.step_seconds)):
            self.step()

    def step(self) -> None:
        """Moves on by one period of the odometry."""
        command, self._command = self._command, None
        self.observation = seen = self._simulation.step(command)
        stamp = rospy.Time.from_sec(self.now)
        odometry = seen.odometry
        odom_in_map = seen.base_in_world @ odometry.base_in_odom.inverse()
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
        if seen.scan is not None:
            self._publish_scan(seen.scan, stamp)
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


def main() -> int:
    options = _options()
    settings, grid, world = load_settings(CONFIG), load_map(options.map), load_world(options.world)
    os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{options.port}"
    master = subprocess.Popen(["rosmaster", "--core", "-p", str(options.port)], stdout=subprocess.DEVNULL)
    node = None
    try:
        while not rosgraph.is_master_online():
            time.sleep(0.1)
        node = _start_node(options)
        rospy.init_node("benchmark", disable_signals=True)
        robot, runs = RobotOverRos(grid, options.speed), []
        for pair in range(options.pairs):
            rng = np.random.default_rng([options.seed, pair])
            start, goal = places(settings, grid, rng, 2)
            simulation = Simulation(world, seed=pair, base_in_world=start)
            for number in range(options.boxes):
                add_box(simulation, f"box_{number}", settings, grid, rng, keep_free=(start, goal))
            robot.put(simulation)
            runs.append(_pursue(robot, goal, psutil.Process(node.pid), options.limit))
            print(pair, runs[-1], flush=True)
        print(json.dumps(_summary(runs), indent=2))
    finally:
        for process in (node, master):
            if process is not None:
                process.terminate()
                process.wait()
    return 0


def _start_node(options) -> subprocess.Popen:
    """The node, its parameters set as the launch file does."""
    parameters = yaml.safe_load(Path(options.config).read_text(encoding="utf-8"))
    parameters.setdefault("DWAPlannerROS", {})["global_frame_id"] = "odom"
    if options.local_planner:
        parameters["base_local_planner"] = options.local_planner
    rospy.set_param("/use_sim_time", True)
    rospy.set_param("/move_base", parameters)
    package, executable = options.node.split("/")
    path = find_node(package, executable)
    if not path:
        raise SystemExit(f"no node {options.node} is installed")
    return subprocess.Popen([path[0], "__name:=move_base"], stdout=sys.stderr)


def _pursue(robot: RobotOverRos, goal: Pose2, process: psutil.Process, limit: float) -> Run:
    client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
    until = time.monotonic() + START_SECONDS
    while not server_is_ready(client):
        robot.step()
        if time.monotonic() > until:
            raise SystemExit("the node does not start")
    robot.step_for(GAP)
    rospy.ServiceProxy("move_base/clear_costmaps", Empty)()
    robot.step_for(GAP)
    cpu, began = sum(process.cpu_times()[:2]), robot.now
    pose = PoseStamped(pose=pose2_to_msg(goal))
    pose.header.frame_id = "map"
    client.send_goal(MoveBaseGoal(pose))
    last, driven, touched = robot.observation.base_in_world, 0.0, set()
    while robot.now - began < limit and client.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE):
        robot.step()
        touched.update(robot.observation.contacts)
        driven += last.distance_to(robot.observation.base_in_world)
        last = robot.observation.base_in_world
    state = client.get_state()
    if state in (GoalStatus.PENDING, GoalStatus.ACTIVE):
        client.cancel_all_goals()
    return Run(
        actionlib.GoalStatus.to_string(state),
        robot.now - began,
        driven,
        last.distance_to(goal),
        sorted(touched),
        sum(process.cpu_times()[:2]) - cpu,
    )


def _summary(runs: List[Run]) -> dict:
    reached = [run for run in runs if run.status == "SUCCEEDED"]
    return {
        "runs": len(runs),
        "reached": len(reached),
        "runs_with_collision": sum(bool(run.touched) for run in runs),
        "mean_seconds": round(float(np.mean([run.seconds for run in reached])), 2),
        "mean_driven": round(float(np.mean([run.driven for run in reached])), 2),
        "cpu_share": round(sum(run.cpu_seconds for run in runs) / sum(run.seconds for run in runs), 3),
    }


def _options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--node", default="move_base_lite/move_base_lite", help="package/executable")
    parser.add_argument("--config", default=CONFIG, help="parameters of move_base")
    parser.add_argument("--local-planner", help="base_local_planner instead of that of the parameters")
    parser.add_argument("--pairs", type=int, default=20, help="number of random pairs of start and goal")
    parser.add_argument("--boxes", type=int, default=0, help="boxes that the map does not show")
    parser.add_argument("--seed", type=int, default=0, help="of all chance")
    parser.add_argument("--speed", type=float, default=1.0, help="simulated seconds a second")
    parser.add_argument("--limit", type=float, default=120.0, help="simulated seconds a drive may take")
    parser.add_argument("--port", type=int, default=11411, help="of the ROS master that is started")
    parser.add_argument("--world", default=ROOT / "map" / "home.world", help="SDF file of the world")
    parser.add_argument("--map", default=ROOT / "map" / "home.yaml", help="map_server file of its map")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
