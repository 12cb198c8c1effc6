#!/usr/bin/env python3
"""Measure missions whose processes are stopped, whose time is paused or reset, or with foreign goals.

python3 tests/benchmarks/troubled_graphs.py [--seed 61] [--only goal_storm ...]
    [--table docs/reports/troubled_graphs.md]
"""

import argparse
import multiprocessing
import subprocess
import sys
import time
from dataclasses import dataclass
from datetime import date
from functools import partial
from pathlib import Path
from typing import Callable, Dict, List

import psutil
from killed_nodes import (
    DRIVING_SECONDS,
    FATAL,
    SPEED,
    WORK,
    processes_of,
    reason_in,
    run_under_way,
    table_row,
    wait_for_end,
)
from soak import Graph, Leftovers

from supervision.versions import provenance

STILL_SECONDS = 5.0
CALL_SECONDS = 10.0
BUSY_SECONDS, BUSY_EACH = 15.0, 4
STORM_GOALS, STORM_SECONDS = 2000, 2.0
CANCELS, CANCELS_APART = 100, 0.05
PAGE = """# Troubled graphs

Look up what happens to a mission when its processes, its time or its topics are disturbed while the robot
drives: wall seconds until the run ends, and the number of processes, sockets and temporary files that are
left.

{provenance}
* Command: `python3 tests/benchmarks/troubled_graphs.py --seed {seed} --table
  docs/reports/troubled_graphs.md`, which runs `./scripts/home_service.sh --mission map/mission.yaml --speed
  {speed}`

| trouble | disturbance | ended after, s | exit code | reason of the run | left |
| --- | --- | --- | --- | --- | --- |
{rows}

Killed processes: [killed nodes](killed_nodes.md). Faults of sensors, drive and environment:
[faults](faults.md).
"""


@dataclass(frozen=True)
class Trouble:
    """A disturbance: its description, and a function that causes it and returns when it is over."""

    what: str
    make: Callable[[Graph], None]


@dataclass(frozen=True)
class TroubleResult:
    """Result of a run; ``ended``: wall seconds since the start of the trouble."""

    name: str
    ended: float
    code: int
    reason: str
    left: int

    @property
    def row(self) -> str:
        what = TROUBLES[self.name].what
        return table_row(self.name, what, f"{self.ended:.1f}", self.code, self.reason, self.left)

    @property
    def is_ok(self) -> bool:
        return self.code == 0 and not self.left


def _stand_still(name: str, graph: Graph) -> None:
    processes = processes_of(graph, name)
    assert processes, f"no process of {name}"
    for process in processes:
        process.suspend()
    time.sleep(STILL_SECONDS)
    for process in processes:
        process.resume()


def _keep_busy(graph: Graph) -> None:
    count = BUSY_EACH * (psutil.cpu_count() or 1)
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        time.sleep(BUSY_SECONDS)
    finally:
        for process in busy:
            process.kill()
            process.wait()


def _pause(graph: Graph) -> None:
    _call("/gazebo/pause_physics")
    time.sleep(STILL_SECONDS)
    _call("/gazebo/unpause_physics")


def _set_time_back(graph: Graph) -> None:
    _call("/gazebo/reset_simulation")


def _call(service: str) -> None:
    import rospy
    from std_srvs.srv import Empty

    rospy.wait_for_service(service, CALL_SECONDS)
    rospy.ServiceProxy(service, Empty)()


def _storm(graph: Graph) -> None:
    """Publish many goals all over the home, as a faulty program might."""
    import rospy
    from move_base_msgs.msg import MoveBaseActionGoal

    goals = rospy.Publisher("/move_base/goal", MoveBaseActionGoal, queue_size=STORM_GOALS)
    _wait_for_connection(goals)
    for number in range(STORM_GOALS):
        goal = MoveBaseActionGoal()
        goal.goal_id.id = f"storm {number}"
        goal.goal.target_pose.header.frame_id = "map"
        goal.goal.target_pose.pose.position.x = number % 5 - 2.0
        goal.goal.target_pose.pose.orientation.w = 1.0
        goals.publish(goal)
        time.sleep(STORM_SECONDS / STORM_GOALS)


def _cancel(graph: Graph) -> None:
    """Cancel all goals repeatedly."""
    import rospy
    from actionlib_msgs.msg import GoalID

    cancels = rospy.Publisher("/move_base/cancel", GoalID, queue_size=CANCELS)
    _wait_for_connection(cancels)
    for _ in range(CANCELS):
        cancels.publish(GoalID())
        time.sleep(CANCELS_APART)


def _wait_for_connection(publisher) -> None:
    deadline = time.monotonic() + 10.0
    while not publisher.get_num_connections() and time.monotonic() < deadline:
        time.sleep(0.02)


TROUBLES: Dict[str, Trouble] = {
    **{
        f"{name}_stands_still": Trouble(
            f"{name} is stopped (SIGSTOP) for {STILL_SECONDS:g} s", partial(_stand_still, name)
        )
        for name in (*WORK, *FATAL)
    },
    "processors_busy": Trouble(
        f"{BUSY_EACH} endless loops for each processor, {BUSY_SECONDS:g} s", _keep_busy
    ),
    "time_stands_still": Trouble(f"the simulation is paused for {STILL_SECONDS:g} s", _pause),
    "time_set_back": Trouble(
        "/gazebo/reset_simulation: time from 0 on, the robot back at its start", _set_time_back
    ),
    "goal_storm": Trouble(f"another node sends {STORM_GOALS} goals in {STORM_SECONDS:g} s", _storm),
    "cancel_race": Trouble(f"another node cancels all goals {CANCELS} times in a row", _cancel),
}


def run_with_trouble(name: str, seed: int) -> TroubleResult:
    """Run in a separate process, because rospy connects to one master."""
    leftovers = Leftovers()
    graph, folder = run_under_way(leftovers, seed)
    time.sleep(DRIVING_SECONDS)
    began = time.monotonic()
    TROUBLES[name].make(graph)
    code = wait_for_end(graph)
    return TroubleResult(name, time.monotonic() - began, code, reason_in(folder), len(leftovers.find()))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=61, help="default: 61")
    parser.add_argument("--only", nargs="+", default=list(TROUBLES), choices=TROUBLES, metavar="TROUBLE")
    parser.add_argument("--table", type=Path, help="Markdown file for the table", metavar="FILE")
    options = parser.parse_args()
    outcomes: List[TroubleResult] = []
    for name in options.only:
        with multiprocessing.Pool(1) as pool:
            outcomes.append(pool.apply(run_with_trouble, (name, options.seed)))
        print(outcomes[-1].row, flush=True)
    if options.table:
        rows = "\n".join(outcome.row for outcome in outcomes)
        options.table.write_text(report(options.seed, rows))
    return int(not all(outcome.is_ok for outcome in outcomes))


def report(seed: int, rows: str) -> str:
    """Return the page of the report, with date, commit and machine of now."""
    return PAGE.format(speed=SPEED, seed=seed, rows=rows, provenance=provenance(date.today()))


if __name__ == "__main__":
    sys.exit(main())
