#!/usr/bin/env python3
"""Measures CPU time and memory of move_base with three obstacle layers, beside the official node.

Both nodes get the same messages at the same time: a scan of 360 beams at 10 Hz and two clouds of 20,000
points of depth cameras at 5 Hz. The local costmap is 4 x 4 m with cells of 0.05 m, at 5 Hz. There is no
goal. The official move_base is measured if it is installed.

python3 tests/benchmarks/costmap_layers.py [--seconds N] [--layers N] [--voxels] [--silent] [--json FILE]
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Dict, List, Optional

import numpy as np
import psutil
import rosgraph
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rospy.numpy_msg import numpy_msg
from sensor_msgs.msg import LaserScan, PointCloud2
from sensor_msgs.point_cloud2 import create_cloud_xyz32
from std_msgs.msg import Header

from planar import OccupancyGrid, Pose2
from planar_ros.messages.conversion import OccupancyGridArrays, grid_to_msg
from supervision.ros.graph import free_port

POINTS, BEAMS = 20_000, 360
SCAN_PERIOD, CLOUD_PERIOD, TRANSFORM_PERIOD = 0.1, 0.2, 0.05
WARM_UP_SECONDS, START_SECONDS = 8.0, 60.0
OUR_NODE = [sys.executable, "-c", "from move_base_lite.ros.node import main; main()"]
OBSTACLES, VOXELS = "costmap_2d::ObstacleLayer", "costmap_2d::VoxelLayer"
SOURCES = {
    "scan": {"data_type": "LaserScan", "clearing": True, "inf_is_valid": True},
    "cloud_1": {"data_type": "PointCloud2", "clearing": True},
    "cloud_2": {"data_type": "PointCloud2", "clearing": True},
}


def parameters(layers: int, kind: str = OBSTACLES) -> Dict[str, Any]:
    """Parameters of move_base with so many obstacle layers of a type in the local costmap."""
    frames = {"robot_base_frame": "base_link", "transform_tolerance": 1.0}
    chosen = [*SOURCES][:layers]
    inflation = {"name": "inflation", "type": "costmap_2d::InflationLayer"}
    obstacles = [{"name": f"{topic}_layer", "type": kind} for topic in chosen]
    tables = {
        f"{topic}_layer": {"observation_sources": topic, topic: {**SOURCES[topic], "topic": f"/{topic}"}}
        for topic in chosen
    }
    static = {"name": "static", "type": "costmap_2d::StaticLayer"}
    return {
        "base_local_planner": "dwa_local_planner/DWAPlannerROS",
        "robot_radius": 0.2,
        "global_costmap": {
            **frames,
            "global_frame": "map",
            "update_frequency": 1.0,
            "plugins": [static, inflation],
            "static": {"map_topic": "/map"},
        },
        "local_costmap": {
            **frames,
            "global_frame": "odom",
            "update_frequency": 5.0,
            "rolling_window": True,
            "width": 4,
            "height": 4,
            "resolution": 0.05,
            "plugins": [*obstacles, inflation],
            **tables,
        },
    }


class Sensors:
    """Publishes map, transforms, odometry, scans and clouds in real time."""

    def __init__(self, is_silent: bool):
        rng = np.random.default_rng(0)
        self._clouds = [
            create_cloud_xyz32(Header(frame_id="base_link"), _camera_points(rng, heading))
            for heading in (0.0, np.pi)
        ]
        self._scan = numpy_msg(LaserScan)(range_min=0.1, range_max=10.0)
        self._scan.header.frame_id = "base_link"
        self._scan.angle_min, self._scan.angle_increment = -np.pi, 2.0 * np.pi / BEAMS
        self._scan.angle_max = self._scan.angle_min + (BEAMS - 1) * self._scan.angle_increment
        self._scan.ranges = rng.uniform(1.0, 5.0, BEAMS).astype(np.float32)
        self._scan.intensities = np.empty(0, np.float32)
        grid = OccupancyGrid(np.zeros((200, 200), np.int8), 0.05, Pose2(-5.0, -5.0))
        self._map = rospy.Publisher("/map", OccupancyGridArrays, queue_size=1, latch=True)
        self._map.publish(grid_to_msg(grid, rospy.Time.now(), "map"))
        self._scans = rospy.Publisher("/scan", numpy_msg(LaserScan), queue_size=2)
        self._cloud_topics = [rospy.Publisher(f"/cloud_{n}", PointCloud2, queue_size=2) for n in (1, 2)]
        self._odometry = rospy.Publisher("/odom", Odometry, queue_size=2)
        self._tf = tf2_ros.TransformBroadcaster()
        self._are_clouds_silent = is_silent

    def run(self, seconds: float) -> None:
        """Publish for a time [s]."""
        start = time.monotonic()
        for step in range(round(seconds / TRANSFORM_PERIOD)):
            self._publish_pose()
            if step % round(SCAN_PERIOD / TRANSFORM_PERIOD) == 0:
                self._scan.header.stamp = rospy.Time.now()
                self._scans.publish(self._scan)
            if step % round(CLOUD_PERIOD / TRANSFORM_PERIOD) == 0 and not self._are_clouds_silent:
                for topic, cloud in zip(self._cloud_topics, self._clouds):
                    cloud.header.stamp = rospy.Time.now()
                    topic.publish(cloud)
            time.sleep(max(0.0, start + (step + 1) * TRANSFORM_PERIOD - time.monotonic()))

    def _publish_pose(self) -> None:
        now, transforms = rospy.Time.now(), []
        for parent, child in (("map", "odom"), ("odom", "base_link")):
            transform = TransformStamped(child_frame_id=child)
            transform.header.stamp, transform.header.frame_id = now, parent
            transform.transform.rotation.w = 1.0
            transforms.append(transform)
        self._tf.sendTransform(transforms)
        odometry = Odometry(child_frame_id="base_link")
        odometry.header.stamp, odometry.header.frame_id = now, "odom"
        odometry.pose.pose.orientation.w = 1.0
        self._odometry.publish(odometry)


def _camera_points(rng: np.random.Generator, heading: float) -> np.ndarray:
    """Points (N, 3) as a depth camera of 60 degrees sees them, between 0.5 and 5 m away."""
    angles, ranges = heading + rng.uniform(-0.52, 0.52, POINTS), rng.uniform(0.5, 5.0, POINTS)
    heights = rng.uniform(0.05, 1.8, POINTS)
    return np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles), heights))


def official_node() -> Optional[List[str]]:
    """Command of the official move_base; None if it is not installed."""
    for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep):
        path = Path(prefix) / "lib/move_base/move_base"
        if path.is_file() and path.read_bytes()[:4] == b"\x7fELF":
            return [str(path)]
    return None


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=30.0, help="of the measurement (default: 30)")
    parser.add_argument("--layers", type=int, default=3, choices=(1, 2, 3), help="number (default: 3)")
    parser.add_argument("--voxels", action="store_true", help="voxel layers instead of obstacle layers")
    parser.add_argument("--silent", action="store_true", help="publish no clouds")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")
    options = parser.parse_args()
    commands = {"ours": OUR_NODE}
    official = official_node()
    if official is not None:
        commands["official"] = official
    with ExitStack() as stack:
        measured = _measure(stack, commands, options)
    print("node       CPU s a second    MiB (RSS)")
    for name, figures in measured.items():
        print(f"{name:10} {figures['cpu']:14.4f} {figures['mebibytes']:12.1f}")
    if official is not None:
        print(f"ratio of CPU time: {measured['ours']['cpu'] / measured['official']['cpu']:.2f}")
    else:
        print("the official move_base is not installed")
    if options.json:
        options.json.write_text(json.dumps(measured, indent=2) + "\n")
    return 0


def _measure(stack: ExitStack, commands: Dict[str, List[str]], options: Any) -> Dict[str, Dict[str, float]]:
    folder = tempfile.mkdtemp(prefix="costmap-layers-")
    stack.callback(shutil.rmtree, folder, ignore_errors=True)
    _start_master(stack, folder)
    for name in commands:
        rospy.set_param(f"/{name}", parameters(options.layers, VOXELS if options.voxels else OBSTACLES))
    sensors = Sensors(options.silent)
    processes = {}
    for name, command in commands.items():
        log = stack.enter_context((Path(folder) / f"{name}.log").open("wb"))
        process = subprocess.Popen([*command, f"__name:={name}"], stdout=log, stderr=log)
        stack.callback(_end, process)
        processes[name] = psutil.Process(process.pid)
    deadline = time.monotonic() + START_SECONDS
    while not all(_is_up(name) for name in commands):
        if time.monotonic() > deadline:
            logs = [path.read_text(errors="replace")[-500:] for path in Path(folder).glob("*.log")]
            raise SystemExit("the nodes have not started:\n" + "\n".join(logs))
        sensors.run(1.0)
    sensors.run(WARM_UP_SECONDS)
    before = {name: sum(process.cpu_times()[:2]) for name, process in processes.items()}
    start = time.monotonic()
    sensors.run(options.seconds)
    elapsed = time.monotonic() - start
    return {
        name: {
            "cpu": (sum(process.cpu_times()[:2]) - before[name]) / elapsed,
            "mebibytes": process.memory_info().rss / 2**20,
        }
        for name, process in processes.items()
    }


def _start_master(stack: ExitStack, folder: str) -> None:
    port = free_port()
    os.environ.update(ROS_MASTER_URI=f"http://127.0.0.1:{port}", ROS_IP="127.0.0.1", ROS_LOG_DIR=folder)
    code = "import rosmaster, sys; rosmaster.rosmaster_main(['rosmaster', '--core', '-p', sys.argv[1]])"
    master = subprocess.Popen([sys.executable, "-c", code, str(port)], stdout=subprocess.DEVNULL)
    stack.callback(_end, master)
    deadline = time.monotonic() + START_SECONDS
    while not rosgraph.is_master_online():
        if time.monotonic() > deadline:
            raise SystemExit("the ROS master has not started")
        time.sleep(0.05)
    rospy.init_node("sensors", disable_signals=True)


def _is_up(name: str) -> bool:
    """Whether a node serves its parameters: it has its map and transforms."""
    try:
        rosgraph.Master("/sensors").lookupService(f"/{name}/local_costmap/set_parameters")
    except rosgraph.MasterError:
        return False
    return True


def _end(process: subprocess.Popen) -> None:
    process.terminate()
    try:
        process.wait(10.0)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


if __name__ == "__main__":
    sys.exit(main())
