#!/usr/bin/env python3
"""Compares a mission in one process with the same seed over ROS: what was decided, when, and on which way.

    python3 tests/benchmarks/both_ways.py [--seeds 42 43 44] [--mission FILE]

Exit code 1 if anything was decided otherwise. The bits differ: over ROS time begins to pass before the first
goal is sent, so that other noise falls on the same place.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional

import numpy as np

from home_service.commands.rehearse import Rehearse
from home_service.headless import HeadlessMission, parcel_for
from home_service.inputs import read_mission

ROOT = Path(__file__).resolve().parents[2]
TRUTH = "/base_pose_ground_truth"
# Metres by which a robot has set out.
SET_OUT = 0.05


class Played(NamedTuple):
    """What was decided, in words; errors at the places, m; the true way, (N, 3) stamp, x, y."""

    decided: List[str]
    errors: Dict[str, float]
    way: np.ndarray

    @property
    def seconds(self) -> float:
        """From when the robot has set out to its end."""
        moved = np.hypot(*(self.way[:, 1:] - self.way[0, 1:]).T) > SET_OUT
        return float(self.way[-1, 0] - self.way[np.argmax(moved), 0])

    def apart(self, other: "Played") -> float:
        """How far, m, the farther of the two ways leads off the other one."""
        mine, theirs = self.way[:, None, 1:], other.way[None, :, 1:]
        distances = np.hypot(*np.moveaxis(mine - theirs, 2, 0))
        return float(max(distances.min(axis=0).max(), distances.min(axis=1).max()))


def in_one_process(seed: int, mission: Optional[Path]) -> Played:
    home = read_mission(Rehearse(seed=seed, mission=mission))
    parcel = None if mission else parcel_for(home.mission)
    run = HeadlessMission(home.world, home.robot, home.grid, home.mission, seed=seed, parcel=parcel).run()
    findings = run.mission_record.result_fields()
    return Played(_decided(findings), findings["position_error"], run.trajectory[:, :3])


def over_ros(seed: int, mission: Optional[Path]) -> Played:
    with tempfile.TemporaryDirectory() as parent:
        options = ["--seed", str(seed), "--output", parent]
        options += [] if mission is None else ["--mission", str(mission)]
        subprocess.run(
            [str(ROOT / "scripts/home_service.sh"), *options], stdout=subprocess.DEVNULL, check=False
        )
        folder = next(Path(parent).iterdir())
        findings = json.loads((folder / "result.json").read_text(encoding="utf-8"))
        trace = [line.split() for line in (folder / "trace.txt").read_text(encoding="utf-8").splitlines()]
    way = np.array([(row[0], row[3], row[4]) for row in trace if row[1:2] == [TRUTH]], dtype=float)
    return Played(_decided(findings), findings["position_error"], way)


def _decided(findings: Dict[str, Any]) -> List[str]:
    """The deliveries with their ends and attempts, and of an errand what its marker told."""
    jobs = [f"{job['name']}: {job['state']}, attempts {job['attempts']}" for job in findings["deliveries"]]
    return [*sorted(jobs), *(findings["markers"] if len(jobs) == 1 else []), findings["final_state"]]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, nargs="+", default=[42, 43, 44], help="default: 42 43 44")
    parser.add_argument("--mission", type=Path, help="deliveries instead of the errand", metavar="FILE")
    options = parser.parse_args()
    print("seed  decisions  driving s: process, ROS  worst error m: process, ROS  ways apart m")
    all_same = True
    for seed in options.seeds:
        ways = in_one_process(seed, options.mission), over_ros(seed, options.mission)
        is_same = ways[0].decided == ways[1].decided
        all_same &= is_same
        seconds, errors = ([f"{one.seconds:.2f}" for one in ways], [max(one.errors.values()) for one in ways])
        print(
            f"{seed:4}  {'the same' if is_same else 'DIFFERENT'}   {', '.join(seconds):>24}  "
            f"{errors[0]:.3f}, {errors[1]:.3f}   {ways[0].apart(ways[1]):.3f}",
            flush=True,
        )
        if not is_same:
            print(f"  in one process: {ways[0].decided}\n  over ROS: {ways[1].decided}")
    return 0 if all_same else 1


if __name__ == "__main__":
    sys.exit(main())
