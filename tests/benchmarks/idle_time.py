#!/usr/bin/env python3
"""Measure how fast idle time passes: a robot in its dock in the home, in one process or over ROS.

python3 tests/benchmarks/idle_time.py [--hours 5] [--stepped 20] [--over-ros]

In turn, an idle hour is skipped and some seconds are stepped, with all sensors of the robot. In one process,
the medians of the multiples of real time by CPU time and their ratio are printed. Over ROS it is the graph of
service.sh with speed 0, of which all steps are taken while a node listens to the odometry; a table has the
medians by wall time and by CPU time. Exit code 1 if an idle hour passes less than 1,000 times as fast as real
time, or 100 times over ROS.
"""

import argparse
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Callable, Dict, List, NamedTuple

import psutil
from helpers.recorded_launch import join_graph, recorded_launch

from auto_docking_lite.poses import pose_when_docked
from evaluation.options import HOME_WORLD
from planar import Pose2
from sim_bridge import Episode, Simulation, load_world
from sim_bridge.docks import with_dock

DOCK, HOUR = Pose2(-1.5, -3.2, 1.57), 3600.0
LEAST, LEAST_OVER_ROS = 1000.0, 100.0
MAP = Path(__file__).resolve().parents[2] / "map"


class Span(NamedTuple):
    """Some time: simulated, wall-clock and CPU [s]."""

    simulated: float
    wall: float
    cpu: float


def main():
    """Measure."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--hours", type=int, default=5)
    parser.add_argument("--stepped", type=float, default=20.0, metavar="SECONDS")
    parser.add_argument("--over-ros", action="store_true")
    options = parser.parse_args()
    if options.over_ros:
        return measure_over_ros(options.hours, options.stepped)
    world, start = with_dock(load_world(HOME_WORLD), DOCK), pose_when_docked(DOCK) @ Pose2(-0.01)
    simulation = Simulation(world, base_in_world=start)
    episode, scene = Episode(simulation, 0.1), simulation.scene
    while not episode.idle(scene.stamp + 1.0):
        episode.advance()
    factors: Dict[str, List[float]] = {"skipped": [], "stepped": []}
    for _ in range(options.hours):
        begin = time.process_time()
        assert episode.idle(scene.stamp + HOUR), "the robot moves"
        factors["skipped"].append(HOUR / (time.process_time() - begin))
        begin = time.process_time()
        for _ in range(round(options.stepped / 0.1)):
            episode.advance()
        factors["stepped"].append(options.stepped / (time.process_time() - begin))
    skipped, stepped = (statistics.median(values) for values in factors.values())
    print(
        f"skipped {skipped:.0f} x real time, stepped {stepped:.0f} x: {skipped / stepped:.0f} times as fast"
    )
    return int(skipped < LEAST)


def measure_over_ros(hours: int, stepped: float) -> int:
    """Print a table of both kinds of spans, and return the exit code."""
    start = pose_when_docked(DOCK) @ Pose2(-0.01)
    with tempfile.TemporaryDirectory() as folder:
        arguments = {
            "world_file": HOME_WORLD,
            "map_file": MAP / "home.yaml",
            "zones_file": MAP / "zones.yaml",
            "state_folder": folder,
            "dock": f"{DOCK.x} {DOCK.y} {DOCK.yaw}",
            **{"x": start.x, "y": start.y, "yaw": start.yaw, "speed": 0},
        }
        launch = ["home_service", "service.launch", *(f"{key}:={value}" for key, value in arguments.items())]
        log = Path(tempfile.gettempdir()) / "idle_time.log"
        spans = recorded_launch(launch, record, (os.getpid(), hours, stepped), 0, log)
    print(f"load average {os.getloadavg()[0]:.1f}\n")
    print("| steps | x real time by wall time | by CPU time | CPU time of an hour |")
    print("| --- | --- | --- | --- |")
    factors = {}
    for kind, each in spans.items():
        wall = factors[kind] = statistics.median(span.simulated / span.wall for span in each)
        cpu = statistics.median(span.simulated / span.cpu for span in each)
        print(f"| {kind} | {wall:.0f} | {cpu:.0f} | {HOUR / cpu:.1f} s |")
    return int(factors["skipped"] < LEAST_OVER_ROS)


def record(master: str, parent: int, hours: int, stepped: float, results: Any) -> None:
    """Put spans of skipped and of stepped time of the graph at ``master`` below a process."""
    join_graph(master)
    import rospy
    from nav_msgs.msg import Odometry
    from std_msgs.msg import Float64

    def span_of(seconds: float) -> Span:
        begin, wall, cpu = rospy.get_time(), time.monotonic(), cpu_seconds(parent)
        wait_until(lambda: rospy.get_time() >= begin + seconds)
        return Span(rospy.get_time() - begin, time.monotonic() - wall, cpu_seconds(parent) - cpu)

    skips: List[Float64] = []
    rospy.Subscriber("sim_bridge/skipped_seconds", Float64, skips.append)
    spans: Dict[str, List[Span]] = {"skipped": [], "stepped": []}
    for _ in range(hours):
        count = len(skips)
        wait_until(lambda: len(skips) > count + 1)  # noqa: B023
        spans["skipped"].append(span_of(HOUR))
        received: List[Odometry] = []
        odometry = rospy.Subscriber("odom", Odometry, received.append)
        wait_until(lambda: len(received) > 10)  # noqa: B023
        spans["stepped"].append(span_of(stepped))
        odometry.unregister()
    results.put(spans)


def cpu_seconds(parent: int) -> float:
    """Return the CPU time of the nodes below a process, this one left out [s]."""
    found = psutil.Process(parent).children(recursive=True)
    times = [each.cpu_times() for each in found if each.pid != os.getpid()]
    return sum(each.user + each.system for each in times)


def wait_until(is_so: Callable[[], bool]) -> None:
    """Wait for a condition."""
    while not is_so():
        time.sleep(0.005)


if __name__ == "__main__":
    sys.exit(main())
