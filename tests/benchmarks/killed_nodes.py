#!/usr/bin/env python3
"""Shows what becomes of a mission, or of a map, when each of the processes is killed by SIGKILL in turn.

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
from pathlib import Path
from typing import Dict, List, Optional, Tuple

import psutil
from soak import ROOT, RUN_SECONDS, RUNS, Graph, Traces

# Those of map_home.sh; the others are a mission's.
MAPPERS = ("slam_gmapping", "explore")
# Of each node that comes back, a topic on which it is heard as soon as it is at work again.
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
# A mission is over too soon otherwise; the robot is on its way by then.
SPEED, DRIVING_SECONDS = 4, 2.0
PAGE = """# Killed nodes

What becomes of `./scripts/home_service.sh --mission map/mission.yaml --speed {speed}`, for slam_gmapping
and explore of `./scripts/map_home.sh --speed {speed}`, when one of its processes is killed (`kill -9`)
while the robot drives: wall seconds until the node is heard at work again, and until the run has ended; and
what of the run is left then, processes, sockets, temporary files. Made by
`python3 tests/benchmarks/killed_nodes.py --seed {seed} --table docs/reports/killed_nodes.md`.

| killed | at work again, s | ended after, s | exit code | what the run says | left |
| --- | --- | --- | --- | --- | --- |
{rows}

A node that has come back goes on with what it has left at the master, or in a file of which the master knows:
amcl with its particles, slam_gmapping with its graph of at most five seconds ago, explore with where it is to
return to, pick_objects with how far its deliveries are and what is carried. rosout collects what nodes log,
and nobody waits for it. Each may die three times. Without the simulator, the master or roslaunch there is no
run. What else goes wrong: [troubled graphs](troubled_graphs.md), [faults](faults.md).
"""


@dataclass(frozen=True)
class Fate:
    """What became of a run; ``back``: seconds until the node that was killed was heard again."""

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


def table_row(name: str, *told: object) -> str:
    """A row of a Markdown table."""
    return f"| `{name}` | " + " | ".join(map(str, told)) + " |"


def fate_of(killed: str, seed: int) -> Fate:
    """For a process of its own: rospy knows one master."""
    traces = Traces()
    graph, folder = run_under_way(traces, seed, makes_map=killed in MAPPERS)
    heard = _listen(killed) if killed in WORK else []
    time.sleep(DRIVING_SECONDS)
    for process in processes_of(graph, killed):
        with suppress(psutil.NoSuchProcess):  # gone with its parent
            process.kill()
    killed_at = time.monotonic()
    code = wait_for_end(graph)
    ended = time.monotonic() - killed_at
    # What it has sent before its end came by a connection that was there.
    known = [connection for moment, connection in heard if moment <= killed_at]
    moments = [moment for moment, connection in heard if all(connection is not other for other in known)]
    back = moments[0] - killed_at if moments else None
    return Fate(killed, back, ended, code, reason_in(folder), len(traces.left()))


def run_under_way(traces: Traces, seed: int, makes_map: bool = False) -> Tuple[Graph, Path]:
    """A run whose robot has set out, and its folder; this process is a node of its graph then."""
    import rospy

    options = ("--speed", str(SPEED), "--seed", str(seed))
    if makes_map:
        graph = Graph(traces, "map_home.sh", *options)
        graph.wait_for("(exploring, )")
    else:
        graph = Graph(traces, "home_service.sh", "--mission", str(ROOT / "map/mission.yaml"), *options)
        graph.wait_for("(driving to)")
    folder = next((Path(traces.environment["TMPDIR"]) / RUNS).iterdir())
    uri = re.search(r"ROS_MASTER_URI=(http://[\d.:]+)", (folder / "log/roslaunch.log").read_text())
    assert uri is not None
    os.environ.update(ROS_MASTER_URI=uri[1], ROS_IP="127.0.0.1")
    rospy.init_node("troublemaker", anonymous=True, disable_signals=True)
    return graph, folder


def reason_in(folder: Path) -> str:
    """What the run says of its end."""
    reason = str(json.loads((folder / "result.json").read_text())["reason"])
    return reason.replace(f", see {folder / 'log'}", "")


def wait_for_end(graph: Graph) -> int:
    """The exit code, also of a run that has to be ended."""
    try:
        return graph.process.wait(RUN_SECONDS)
    except subprocess.TimeoutExpired:
        return graph.end()


def _listen(node: str) -> List[Tuple[float, Dict[str, str]]]:
    """A list that grows by the moments at which the node is heard, each with the connection's header."""
    import rospy

    heard: List[Tuple[float, Dict[str, str]]] = []

    def hear(message):
        if message._connection_header["callerid"] == f"/{node}":
            heard.append((time.monotonic(), message._connection_header))

    rospy.Subscriber(WORK[node], rospy.AnyMsg, hear)
    return heard


def processes_of(graph: Graph, name: str) -> List[psutil.Process]:
    """Those of a node, or of one of ROS' own programs."""
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
    fates: Dict[str, Fate] = {}
    for name in options.only:
        with multiprocessing.Pool(1) as pool:
            fates[name] = pool.apply(fate_of, (name, options.seed))
        print(fates[name].row, flush=True)
    if options.table:
        rows = "\n".join(fate.row for fate in fates.values())
        options.table.write_text(PAGE.format(speed=SPEED, seed=options.seed, rows=rows))
    survivors = [name for name in WORK if name in fates]
    is_well = all(fates[name].code == 0 and fates[name].back is not None for name in survivors)
    return int(not is_well or any(fate.left for fate in fates.values()))


if __name__ == "__main__":
    sys.exit(main())
