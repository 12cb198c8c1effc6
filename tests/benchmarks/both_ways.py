#!/usr/bin/env python3
"""Compares a mission in one process with the same seed over ROS: decisions, times and trajectories.

    python3 tests/benchmarks/both_ways.py [--seeds 42 43 44] [--mission FILE]

Exit code 1 if a decision differs. Trajectories are not bit-identical: over ROS time passes before the first
goal is sent, so the noise differs.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional

import numpy as np

from headless_mission import HeadlessMission, parcel_for
from headless_mission.inputs import read_mission
from home_service.commands.rehearse import Rehearse

ROOT = Path(__file__).resolve().parents[2]
TRUTH = "/base_pose_ground_truth"
# Distance from the start at which the robot counts as moving [m].
DEPARTURE_DISTANCE = 0.05


class MissionTrace(NamedTuple):
    """Decisions as texts, position errors at the places [m], true path (N, 3) of stamp, x, y."""

    events: List[str]
    errors: Dict[str, float]
    path: np.ndarray

    @property
    def seconds(self) -> float:
        """Time from the first motion to the end [s]."""
        moved = np.hypot(*(self.path[:, 1:] - self.path[0, 1:]).T) > DEPARTURE_DISTANCE
        return float(self.path[-1, 0] - self.path[np.argmax(moved), 0])

    def max_deviation(self, other: "MissionTrace") -> float:
        """Maximum distance between the two paths [m]."""
        own, others = self.path[:, None, 1:], other.path[None, :, 1:]
        distances = np.hypot(*np.moveaxis(own - others, 2, 0))
        return float(max(distances.min(axis=0).max(), distances.min(axis=1).max()))


def in_one_process(seed: int, mission: Optional[Path]) -> MissionTrace:
    home = read_mission(Rehearse(seed=seed, mission=mission))
    parcel = None if mission else parcel_for(home.mission)
    run = HeadlessMission(home.world, home.robot, home.grid, home.mission, seed=seed, parcel=parcel).run()
    findings = run.mission_record.result_fields()
    return MissionTrace(_decided(findings), findings["position_error"], run.trajectory[:, :3])


def over_ros(seed: int, mission: Optional[Path]) -> MissionTrace:
    with tempfile.TemporaryDirectory() as parent:
        options = ["--seed", str(seed), "--output", parent]
        options += [] if mission is None else ["--mission", str(mission)]
        subprocess.run(
            [str(ROOT / "scripts/home_service.sh"), *options], stdout=subprocess.DEVNULL, check=False
        )
        folder = next(Path(parent).iterdir())
        findings = json.loads((folder / "result.json").read_text(encoding="utf-8"))
        trace = [line.split() for line in (folder / "trace.txt").read_text(encoding="utf-8").splitlines()]
    path = np.array([(row[0], row[3], row[4]) for row in trace if row[1:2] == [TRUTH]], dtype=float)
    return MissionTrace(_decided(findings), findings["position_error"], path)


def _decided(findings: Dict[str, Any]) -> List[str]:
    """Final state and attempts of each delivery, and the marker events of the errand."""
    jobs = [f"{job['name']}: {job['state']}, attempts {job['attempts']}" for job in findings["deliveries"]]
    return [*sorted(jobs), *(findings["markers"] if len(jobs) == 1 else []), findings["final_state"]]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, nargs="+", default=[42, 43, 44], help="default: 42 43 44")
    parser.add_argument("--mission", type=Path, help="mission file instead of the errand", metavar="FILE")
    options = parser.parse_args()
    print("seed  decisions  driving s: process, ROS  worst error m: process, ROS  max deviation m")
    all_same = True
    for seed in options.seeds:
        traces = in_one_process(seed, options.mission), over_ros(seed, options.mission)
        is_same = traces[0].events == traces[1].events
        all_same &= is_same
        seconds = [f"{trace.seconds:.2f}" for trace in traces]
        errors = [max(trace.errors.values()) for trace in traces]
        print(
            f"{seed:4}  {'the same' if is_same else 'DIFFERENT'}   {', '.join(seconds):>24}  "
            f"{errors[0]:.3f}, {errors[1]:.3f}   {traces[0].max_deviation(traces[1]):.3f}",
            flush=True,
        )
        if not is_same:
            print(f"  in one process: {traces[0].events}\n  over ROS: {traces[1].events}")
    return 0 if all_same else 1


if __name__ == "__main__":
    sys.exit(main())
