#!/usr/bin/env python3
"""Measure the real-time factor of a simulator node with subscribers to its clock, odometry and scans.

Works with any node that drives a robot by cmd_vel, so that simulators can be compared:

    python3 tests/benchmarks/simulator_over_ros.py
    python3 tests/benchmarks/simulator_over_ros.py --scan base_scan -- rosrun stage_ros stageros -g home.world
"""

import argparse
import contextlib
import json
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import rospy
from geometry_msgs.msg import Twist
from helpers.lockstep import Master, Node
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan

ROOT = Path(__file__).resolve().parents[2]
OURS = ["rosrun", "sim_bridge", "sim_bridge", f"_world:={ROOT}/map/home.world", "_speed:=0"]
# A circle that stays clear of the home's furniture.
SPEED, TURN = 0.2, 0.5
SCANS_BEFORE, START_SECONDS = 5, 60.0


@dataclass(frozen=True)
class Measurement:
    """Figures of a run; ``cpu_ms``: CPU time per simulated second; rates are per simulated second."""

    real_time_factor: float
    cpu_ms: float
    memory_mb: float
    scan_rate: float
    odometry_rate: float


class Meter:
    """Drives the robot in a circle and counts the messages it receives."""

    def __init__(self, scan_topic: str):
        self._scans = self._odometry = 0
        self._now = 0.0
        options = {"queue_size": 50, "tcp_nodelay": True}
        rospy.Subscriber(scan_topic, LaserScan, self._on_scan, **options)
        rospy.Subscriber("odom", Odometry, self._on_odometry, **options)
        rospy.Subscriber("clock", Clock, self._on_clock, **options)
        self._commands = rospy.Publisher("cmd_vel", Twist, queue_size=1)

    def wait_for_scans(self) -> None:
        """Wait for the first scans. Raises SystemExit if there are none."""
        until = time.monotonic() + START_SECONDS
        while self._scans < SCANS_BEFORE:
            if time.monotonic() > until:
                raise SystemExit(f"error: no scans from the simulator in {START_SECONDS:.0f} s")
            time.sleep(0.1)

    def measure(self, node: Node, seconds: float) -> Measurement:
        """Measure for some seconds of wall time."""
        before, cpu, began = self._counts(), node.cpu_seconds(), time.monotonic()
        command = Twist()
        command.linear.x, command.angular.z = SPEED, TURN
        while time.monotonic() - began < seconds:
            self._commands.publish(command)
            time.sleep(0.1)
        wall, cpu = time.monotonic() - began, node.cpu_seconds() - cpu
        simulated, scans, odometry = (now - then for now, then in zip(self._counts(), before))
        return Measurement(
            simulated / wall,
            1e3 * cpu / simulated,
            node.resident_megabytes(),
            scans / simulated,
            odometry / simulated,
        )

    def _counts(self):
        return self._now, self._scans, self._odometry

    def _on_scan(self, _message):
        self._scans += 1

    def _on_odometry(self, _message):
        self._odometry += 1

    def _on_clock(self, message):
        self._now = message.clock.to_sec()


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("command", nargs="*", default=OURS, help="starts the simulator (default: ours)")
    parser.add_argument("--scan", default="scan", help="topic of its laser (%(default)s)")
    parser.add_argument("--seconds", type=float, default=15.0, help="wall time measured (%(default)s)")
    parser.add_argument("--port", type=int, default=11412, help="of the ROS master that is started")
    parser.add_argument("--json", type=Path, metavar="FILE", help="writes the figures there too")
    options = parser.parse_args()
    with contextlib.closing(Master(options.port)), contextlib.closing(Node(options.command)) as node:
        meter = Meter(options.scan)
        meter.wait_for_scans()
        measured = meter.measure(node, options.seconds)
    print("  x real   CPU ms/s     MB  scans/s   odom/s")
    print("{:8.2f} {:10.1f} {:6.0f} {:8.1f} {:8.1f}".format(*asdict(measured).values()))
    if options.json:
        options.json.write_text(json.dumps(asdict(measured), indent=2) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
