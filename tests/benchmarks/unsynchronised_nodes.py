#!/usr/bin/env python3
"""Repeat missions with an amcl and a move_base that do not support lock-step, such as the official ones.

python3 tests/benchmarks/unsynchronised_nodes.py [--seeds 0 1 2] [--runs 2] [--busy 2] [--json FILE]

Each seed is run several times, with ``--busy`` the last time beside that many busy processes. Compare what
the runs of a seed did: outcome, and true trajectories at equal simulated times. The packages are those that
rospack finds under the names given. Exit code 1 if the outcome of a seed differs between its runs.
"""

import argparse
import itertools
import json
import sys
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Dict, List, Tuple

import numpy as np
from helpers.recorded_launch import join_graph, recorded_launch

ROOT = Path(__file__).resolve().parents[2]
# Stages after which a mission of pick_objects is over.
OVER = ("delivered", "failed", "cancelled")
SAME = 1e-6


@dataclass
class MissionRun:
    """What one mission did, by simulated time [s].

    Attributes:
        seed: Seed of the simulation.
        is_busy: Whether busy processes ran beside it.
        truth: True poses (N, 4): stamp, x, y, yaw.
        estimates: Poses of amcl (N, 4).
        commands: Velocity commands (N, 3): simulated time of arrival, v, omega.
        goals: Results of move_base: stamp, status.
        states: States of pick_objects.
        wall_seconds: Wall time from the first to the last true pose.
    """

    seed: int
    is_busy: bool
    truth: List[Tuple[float, ...]] = field(default_factory=list)
    estimates: List[Tuple[float, ...]] = field(default_factory=list)
    commands: List[Tuple[float, ...]] = field(default_factory=list)
    goals: List[Tuple[float, int]] = field(default_factory=list)
    states: List[str] = field(default_factory=list)
    wall_seconds: float = 0.0

    @property
    def outcome(self) -> str:
        """States of the mission, and the final status of each goal."""
        return " ".join([*self.states, *(str(status) for _, status in self.goals)])

    @property
    def speed(self) -> float:
        """Simulated time, from the first command on, as a multiple of wall time."""
        return (self.truth[-1][0] - self.truth[0][0]) / max(self.wall_seconds, 1e-9) if self.truth else 0.0


@dataclass(frozen=True)
class Difference:
    """How two runs of a seed differ.

    Attributes:
        distance: Largest distance between true positions at equal times [m].
        end: Difference of the times at which they ended [s].
        truth_from: Time from which true poses differ by over 1 mm [s]; as the others, NaN: never.
        estimates_from: Time from which amcl's poses differ [s].
        commands_from: Time from which velocity commands differ [s].
    """

    distance: float
    end: float
    truth_from: float
    estimates_from: float
    commands_from: float


def difference(first: MissionRun, second: MissionRun) -> Difference:
    """Compare two runs of a seed."""
    before, after = (np.array(run.truth).reshape(-1, 4) for run in (first, second))
    _, ours, theirs = np.intersect1d(
        np.rint(before[:, 0] * 1e6), np.rint(after[:, 0] * 1e6), return_indices=True
    )
    distances = np.hypot(*(before[ours, 1:3] - after[theirs, 1:3]).T)
    apart = np.flatnonzero(distances > 1e-3)
    return Difference(
        float(distances.max(initial=0.0)),
        abs(float(before[-1, 0] - after[-1, 0])),
        float(before[ours[apart[0]], 0]) if len(apart) else float("nan"),
        first_difference(first.estimates, second.estimates),
        first_difference(first.commands, second.commands, compared=slice(1, None)),
    )


def first_difference(
    first: List[Tuple[float, ...]], second: List[Tuple[float, ...]], compared: slice = slice(None)
) -> float:
    """Return the time of the first row that differs in the compared columns; NaN if there is none."""
    for ours, theirs in zip(first, second):
        if any(abs(one - other) > SAME for one, other in zip(ours[compared], theirs[compared])):
            return min(ours[0], theirs[0])
    return float("nan")


def run_mission(options: argparse.Namespace, seed: int, is_busy: bool) -> MissionRun:
    """Run a mission and record it."""
    launch = ["home_service", "home_service.launch", *_arguments(options, seed)]
    busy = options.busy if is_busy else 0
    run: MissionRun = recorded_launch(launch, _record, (seed, is_busy), busy, options.log)
    return run


def _arguments(options: argparse.Namespace, seed: int) -> List[str]:
    home = ROOT / "map"
    arguments = [f"world_file:={home / 'home.world'}", f"map_file:={home / 'home.yaml'}"]
    arguments += [f"zones_file:={home / 'zones.yaml'}", f"seed:={seed}", f"speed:={options.speed}"]
    arguments += [f"pace:={options.pace}"] if options.pace else []
    arguments += ["ordered:=true"] if options.ordered else []
    arguments += [f"clock_rate:={options.clock_rate}"] if options.clock_rate else []
    return [*arguments, f"amcl_pkg:={options.amcl}", f"move_base_pkg:={options.move_base}"]


def _record(master: str, seed: int, is_busy: bool, results: Any) -> None:
    import rospy
    from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
    from move_base_msgs.msg import MoveBaseActionResult
    from nav_msgs.msg import Odometry
    from std_msgs.msg import String

    from planar_ros.messages.conversion import pose2_from_msg

    join_graph(master)
    run, begun = MissionRun(seed, is_busy), [0.0]

    def stamped(message: Any) -> Tuple[float, ...]:
        pose = pose2_from_msg(message.pose.pose)
        return (message.header.stamp.to_sec(), pose.x, pose.y, pose.yaw)

    def on_truth(message: Any) -> None:
        run.truth.append(stamped(message))
        if not run.commands:
            begun[0] = time.monotonic()
        run.wall_seconds = time.monotonic() - begun[0]

    def on_estimate(message: Any) -> None:
        run.estimates.append(stamped(message))

    def on_command(message: Any) -> None:
        run.commands.append((run.truth[-1][0] if run.truth else 0.0, message.linear.x, message.angular.z))

    def on_state(message: Any) -> None:
        run.states.append(message.data)
        if message.data in OVER:
            results.put(run)

    def on_result(message: Any) -> None:
        run.goals.append((message.header.stamp.to_sec(), message.status.status))

    rospy.Subscriber("base_pose_ground_truth", Odometry, on_truth, tcp_nodelay=True)
    rospy.Subscriber("amcl_pose", PoseWithCovarianceStamped, on_estimate, tcp_nodelay=True)
    rospy.Subscriber("cmd_vel", Twist, on_command, tcp_nodelay=True)
    rospy.Subscriber("move_base/result", MoveBaseActionResult, on_result, tcp_nodelay=True)
    rospy.Subscriber("pick_objects/state", String, on_state, tcp_nodelay=True)
    while True:
        time.sleep(1.0)


def main() -> int:
    options = _options()
    print(
        "seed  x real time   apart [m]  end [s]  differ from [s]: truth, amcl, cmd_vel  outcome", flush=True
    )
    rows: List[Dict[str, Any]] = []
    for seed in options.seeds:
        busy = [options.busy > 0 and number == options.runs - 1 for number in range(options.runs)]
        runs = [run_mission(options, seed, is_busy) for is_busy in busy]
        compared = [difference(*pair) for pair in itertools.combinations(runs, 2)]
        worst = max(compared, key=lambda each: each.distance)
        outcomes = sorted({run.outcome for run in runs})
        speeds = [round(run.speed, 2) for run in runs]
        rows.append({"seed": seed, "speeds": speeds, "outcomes": outcomes, **asdict(worst)})
        print(
            f"{seed:4}  {' '.join(f'{speed:5.2f}' for speed in speeds)}"
            f"  {worst.distance:9.4f}  {worst.end:7.2f}  {worst.truth_from:8.2f}"
            f" {worst.estimates_from:8.2f} {worst.commands_from:8.2f}  {' | '.join(outcomes)}",
            flush=True,
        )
    apart = np.array([row["distance"] for row in rows])
    same = sum(len(row["outcomes"]) == 1 for row in rows)
    speed = np.median([speed for row in rows for speed in row["speeds"]])
    print(
        f"{same} of {len(rows)} seeds with one outcome; apart by at most 1 mm {(apart <= 1e-3).mean():.0%}, "
        f"5 cm {(apart <= 0.05).mean():.0%}; median speed {speed:.2f}"
    )
    if options.json:
        options.json.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")
    return 0 if same == len(rows) else 1


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, nargs="+", default=[0, 1, 2], help="default: 0 1 2")
    parser.add_argument("--runs", type=int, default=2, help="runs of each seed (default: 2)")
    parser.add_argument(
        "--busy", type=int, default=0, help="busy processes beside each last run (default: 0)"
    )
    parser.add_argument("--amcl", default="amcl", help="package of amcl (default: amcl)")
    parser.add_argument("--move-base", default="move_base", help="package of move_base (default: move_base)")
    parser.add_argument("--pace", default="", help="rules of nodes, as NODE:RULE (default: the known ones)")
    parser.add_argument("--ordered", action="store_true", help="preload libordered_wake.so into move_base")
    parser.add_argument("--clock-rate", type=int, help="rate of /clock [Hz] (default: the launch file's)")
    parser.add_argument("--speed", default="0", help="0: as fast as the nodes keep up (default)")
    parser.add_argument(
        "--log", type=Path, default=Path("unsynchronised_nodes.log"), help="output of the nodes"
    )
    parser.add_argument("--json", type=Path, help="also write the table here")
    options = parser.parse_args()
    if options.runs < 2:
        parser.error("--runs: at least 2, which are compared")
    return options


if __name__ == "__main__":
    sys.exit(main())
