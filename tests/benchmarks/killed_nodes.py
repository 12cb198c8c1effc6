#!/usr/bin/env python3
"""Measure missions and mappings in which one process is killed by SIGKILL.

python3 tests/benchmarks/killed_nodes.py [--seed 61] [--only amcl ...] [--table docs/reports/killed_nodes.md]
"""

import argparse
import json
import multiprocessing
import os
import re
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Dict, List, Optional, Tuple

import psutil
from soak import ROOT, RUN_SECONDS, RUNS, Graph, Leftovers

from supervision.versions import provenance

# Nodes of map_home.sh; the others run in a mission.
MAPPERS = ("slam_gmapping", "explore")
# A topic of each restarted node, on which it publishes as soon as it works again.
WORK = {
    "amcl": "/tf",
    "move_base": "/cmd_vel",
    "pick_objects": "/pick_objects/mission_state",
    "map_server": "/map",
    "add_markers": "/visualization_marker",
    "robot_state_publisher": "/tf_static",
    "rosout": "/rosout_agg",
    "slam_gmapping": "/map",
    "explore": "/explore/feedback",
}
FATAL = ("sim_bridge", "rosmaster", "roslaunch")
# A faster mission would end too early; after DRIVING_SECONDS the robot drives.
SPEED, DRIVING_SECONDS = 4, 2.0
PAGE = """# Killed nodes

Look up what happens to a mission when one of its processes is killed with `kill -9` while the robot drives:
wall seconds until the restarted node publishes again and until the run ends, and the number of processes,
sockets and temporary files that are left.

{provenance}
* Command: `python3 tests/benchmarks/killed_nodes.py --seed {seed} --table docs/reports/killed_nodes.md`,
  which runs `./scripts/home_service.sh --mission map/mission.yaml --speed {speed}`, and
  `./scripts/map_home.sh --speed {speed}` for slam_gmapping and explore

| killed | publishes again, s | ended after, s | exit code | reason of the run | left |
| --- | --- | --- | --- | --- | --- |
{rows}

A restarted node continues from its [checkpoint](../reference/missions.md#after-a-crash), at most three
times. The run ends when the simulator, the master or roslaunch dies.
"""


@dataclass(frozen=True)
class KillResult:
    """Result of a run; ``back``: wall seconds until the killed node published again."""

    killed: str
    back: Optional[float]
    ended: float
    code: int
    reason: str
    left: int

    @property
    def row(self) -> str:
        back = "" if self.back is None else f"{self.back:.1f}"
        return table_row(self.killed, back, f"{self.ended:.1f}", self.code, self.reason, self.left)


def table_row(name: str, *cells: object) -> str:
    """Return a row of a Markdown table."""
    return f"| `{name}` | " + " | ".join(map(str, cells)) + " |"


def run_with_kill(killed: str, seed: int) -> KillResult:
    """Run in a separate process, because rospy connects to one master."""
    leftovers = Leftovers()
    graph, folder = run_under_way(leftovers, seed, makes_map=killed in MAPPERS)
    received = _subscribe(killed) if killed in WORK else []
    time.sleep(DRIVING_SECONDS)
    for process in processes_of(graph, killed):
        with suppress(psutil.NoSuchProcess):  # gone with its parent
            process.kill()
    killed_at = time.monotonic()
    code = wait_for_end(graph)
    ended = time.monotonic() - killed_at
    # Messages sent before its end may arrive later, on a connection that was there.
    known = [connection for stamp, connection in received if stamp <= killed_at]
    stamps = [stamp for stamp, connection in received if all(connection is not other for other in known)]
    back = stamps[0] - killed_at if stamps else None
    return KillResult(killed, back, ended, code, reason_in(folder), len(leftovers.find()))


def run_under_way(leftovers: Leftovers, seed: int, makes_map: bool = False) -> Tuple[Graph, Path]:
    """Start a run, wait until the robot drives, and join its graph; return the graph and its folder."""
    options = ("--speed", str(SPEED), "--seed", str(seed))
    if makes_map:
        graph = Graph(leftovers, "map_home.sh", *options)
        graph.wait_for("(exploring, )")
    else:
        graph = Graph(leftovers, "home_service.sh", "--mission", str(ROOT / "map/mission.yaml"), *options)
        graph.wait_for("(driving to)")
    folder = next((Path(leftovers.environment["TMPDIR"]) / RUNS).iterdir())
    join_graph(folder)
    return graph, folder


def join_graph(folder: Path) -> None:
    """Make this process a node of the graph with this run folder."""
    import rospy

    uri = re.search(r"ROS_MASTER_URI=(http://[\d.:]+)", (folder / "log/roslaunch.log").read_text())
    assert uri is not None
    os.environ.update(ROS_MASTER_URI=uri[1], ROS_IP="127.0.0.1")
    rospy.init_node("benchmark", anonymous=True, disable_signals=True)


def reason_in(folder: Path) -> str:
    """Return the reason of the run in result.json."""
    reason = str(json.loads((folder / "result.json").read_text())["reason"])
    return reason.replace(f", see {folder / 'log'}", "")


def wait_for_end(graph: Graph) -> int:
    """Wait for the exit code; end a run that takes too long."""
    try:
        return graph.process.wait(RUN_SECONDS)
    except subprocess.TimeoutExpired:
        return graph.end()


def _subscribe(node: str) -> List[Tuple[float, Dict[str, str]]]:
    """Return a list to which receive times [wall s] and connection headers of a node's messages are added."""
    import rospy

    received: List[Tuple[float, Dict[str, str]]] = []

    def on_message(message):
        if message._connection_header["callerid"] == f"/{node}":
            received.append((time.monotonic(), message._connection_header))

    rospy.Subscriber(WORK[node], rospy.AnyMsg, on_message)
    return received


def processes_of(graph: Graph, name: str) -> List[psutil.Process]:
    """Return the processes of a node, or of a ROS program."""
    found = []
    for process in psutil.Process(graph.process.pid).children(recursive=True):
        words = process.cmdline()
        if f"__name:={name}" in words or any(Path(word).name == name for word in words[:2]):
            found.append(process)
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=61, help="default: 61")
    parser.add_argument("--only", nargs="+", default=[*WORK, *FATAL], choices=[*WORK, *FATAL], metavar="NODE")
    parser.add_argument("--table", type=Path, help="Markdown file for the table", metavar="FILE")
    options = parser.parse_args()
    results: Dict[str, KillResult] = {}
    for name in options.only:
        with multiprocessing.Pool(1) as pool:
            results[name] = pool.apply(run_with_kill, (name, options.seed))
        print(results[name].row, flush=True)
    if options.table:
        rows = "\n".join(result.row for result in results.values())
        options.table.write_text(report(options.seed, rows))
    survivors = [name for name in WORK if name in results]
    is_ok = all(results[name].code == 0 and results[name].back is not None for name in survivors)
    return int(not is_ok or any(result.left for result in results.values()))


def report(seed: int, rows: str) -> str:
    """Return the page of the report, with date, commit and machine of now."""
    return PAGE.format(speed=SPEED, seed=seed, rows=rows, provenance=provenance(date.today()))


if __name__ == "__main__":
    sys.exit(main())
