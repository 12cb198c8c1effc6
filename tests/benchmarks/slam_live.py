#!/usr/bin/env python3
"""Measure the latency of slam_lite's node: from a scan to its insertion, and to the updated map.

A simulated office of 20 m x 20 m, a lidar of 360 beams at 10 Hz, wall time. Latencies are those that another
node observes: from publishing a scan to the node's progress report, and from the scan at which a map is due
to the map's arrival.

    python3 tests/benchmarks/slam_live.py --seconds 120 --json runs/slam_live.json
"""

import argparse
import contextlib
import json
import sys
import time
from pathlib import Path
from typing import Any, Dict, List

import numpy as np
import rospy
from helpers.drives import Observation, random_drive
from helpers.lockstep import Master, Node
from helpers.worlds import OFFICE, world_from_picture
from rich.console import Console
from rich.table import Table
from rosgraph_msgs.msg import Clock
from roslib.packages import find_node
from std_msgs.msg import Header
from tf2_ros import StaticTransformBroadcaster

from planar import Pose2
from planar_ros.lockstep.ticker import PROGRESS_TOPIC as PROGRESS
from planar_ros.messages.conversion import LaserScanArrays, OccupancyGridArrays, transform_msg
from planar_ros.messages.transforms import Transforms
from sim_bridge.views.true_map import true_map

START = Pose2(1.0, 1.0, 0.0)
MAP_INTERVAL, BEGIN, START_SECONDS = 2.0, 10.0, 60.0
PARAMETERS = {"base_frame": "base_footprint", "map_update_interval": MAP_INTERVAL}
PARAMETERS.update({"xmin": -10.0, "ymin": -10.0, "xmax": 10.0, "ymax": 10.0})


def big_office() -> str:
    """OFFICE repeated two and a half times: 20 m x 20 m."""
    top, *inside, bottom = OFFICE.strip().splitlines()
    return "\n".join([top, *(3 * inside)[:38], bottom])


class LiveTest:
    """Plays a drive to the node, and records its latencies [s]."""

    def __init__(self):
        self._published: Dict[int, float] = {}
        self._map_due_at: List[float] = []
        self.inserted: List[float] = []
        self.redrawn: List[float] = []
        self._clock = rospy.Publisher("/clock", Clock, queue_size=10, tcp_nodelay=True)
        self._scans = rospy.Publisher("scan", LaserScanArrays, queue_size=10, tcp_nodelay=True)
        self._transforms = Transforms()
        self._static = StaticTransformBroadcaster()
        rospy.Subscriber(PROGRESS, Header, self._on_progress, tcp_nodelay=True)
        rospy.Subscriber("map", OccupancyGridArrays, self._on_map, tcp_nodelay=True)

    def wait_for_node(self) -> None:
        until = time.monotonic() + START_SECONDS
        while self._scans.get_num_connections() == 0:
            if time.monotonic() > until:
                raise SystemExit("error: the node does not start")
            time.sleep(0.1)

    def play(self, drive: List[Observation]) -> None:
        laser = drive[0].scan.laser_in_base
        self._static.sendTransform(transform_msg(laser, "base_footprint", "laser", rospy.Time(BEGIN)))
        began, last_map = time.monotonic(), -np.inf
        for observation in drive:
            time.sleep(max(0.0, began + observation.scan.stamp - time.monotonic()))
            stamp = rospy.Time.from_sec(BEGIN + observation.scan.stamp)
            self._clock.publish(Clock(stamp))
            self._transforms.send(observation.base_in_odom, "odom", "base_footprint", stamp)
            now = time.monotonic()
            if stamp.to_sec() - last_map >= MAP_INTERVAL:
                last_map = stamp.to_sec()
                self._map_due_at.append(now)
            self._published[stamp.to_nsec()] = now
            self._scans.publish(_message_of(observation.scan, stamp))
        time.sleep(1.0)

    def _on_progress(self, message):
        self.inserted.append(time.monotonic() - self._published[message.stamp.to_nsec()])

    def _on_map(self, message):
        self.redrawn.append(time.monotonic() - self._map_due_at[-1])


def _message_of(scan, stamp) -> LaserScanArrays:
    message = LaserScanArrays()
    message.header.stamp, message.header.frame_id = stamp, "laser"
    message.angle_min, message.angle_increment = scan.angle_min, scan.angle_increment
    message.range_min, message.range_max = scan.range_min, scan.range_max
    message.ranges, message.intensities = scan.ranges, np.empty(0, dtype=np.float32)
    return message


def main() -> int:
    options = _options()
    world = world_from_picture("office", big_office())
    grid = true_map(world, inside=(START.x, START.y))
    drive = random_drive(world, grid, options.seed, options.seconds, start=START)
    with contextlib.closing(Master(options.port)):
        rospy.set_param("/slam_gmapping", PARAMETERS)
        with contextlib.closing(Node(find_node("slam_lite", "slam_gmapping"))) as node:
            test = LiveTest()
            test.wait_for_node()
            cpu = node.cpu_seconds()
            test.play(drive)
            _report(test, drive, node.cpu_seconds() - cpu, node.resident_megabytes(), options.json)
    return 0


def _report(test: LiveTest, drive: List[Observation], cpu: float, memory_mb: float, path: Path) -> None:
    table = Table(title=f"{len(drive)} scans of {len(drive[0].scan.ranges)} beams, ms")
    for heading in ("", "count", "median", "p99", "max"):
        table.add_column(heading, justify="right")
    figures: Dict[str, Any] = {"cpu_share": cpu / drive[-1].scan.stamp, "memory_mb": memory_mb}
    for name, delays in (("scan inserted", test.inserted), ("map redrawn", test.redrawn)):
        spread = [1e3 * float(np.percentile(delays, share)) for share in (50, 99, 100)]
        table.add_row(name, str(len(delays)), *(f"{value:.1f}" for value in spread))
        figures[name] = {"count": len(delays), **dict(zip(("median_ms", "p99_ms", "max_ms"), spread))}
    Console().print(table)
    print(f"CPU share of the node {figures['cpu_share']:.2f}, memory {memory_mb:.0f} MB")
    if path:
        path.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")


def _options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=120.0, help="length of the drive (default: 120)")
    parser.add_argument("--seed", type=int, default=0, help="of the drive and all noise (default: 0)")
    parser.add_argument("--json", type=Path, help="write the figures here")
    parser.add_argument("--port", type=int, default=11412, help="of the ROS master that is started")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
