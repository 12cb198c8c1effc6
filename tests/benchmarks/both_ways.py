#!/usr/bin/env python3
"""Compares a mission in one process with the same seed over ROS: decisions, and the true path bit for bit.

    python3 tests/benchmarks/both_ways.py [--seeds 42 43 44] [--mission FILE]

The mission in one process starts when the first goal was sent over ROS, with values of the precision of
messages. The last column is the largest distance of the path with exact values. Exit code 1 if anything else
differs.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional

import numpy as np

from headless_mission import EpisodeConditions, EpisodeResult, HeadlessMission, parcel_for
from headless_mission.encoding import Encoding, ExactValues, MessageValues
from headless_mission.inputs import read_mission
from home_service.commands.rehearse import Rehearse
from planar.geometry.pose import quaternion_zw
from sim_bridge.config import LATENCY

ROOT = Path(__file__).resolve().parents[2]
TRUTH, GOAL = "/base_pose_ground_truth", "/move_base/current_goal"
SCRIPT_SECONDS = 300.0


class RosRun(NamedTuple):
    """A run over ROS: result.json, when its first goal was sent [s], true x, y, z and w by stamp [ms]."""

    findings: Dict[str, Any]
    mission_start: float
    poses: Dict[int, List[float]]


class Comparison(NamedTuple):
    """A seed in both ways.

    ``poses``: compared; ``differs_at``: stamp of the first pose that differs [s]; ``deviation``: of the path
    with exact values [m]; ``remarks``: why the run over ROS may not be repeatable.
    """

    over_ros: List[str]
    in_one_process: List[str]
    poses: int
    differs_at: Optional[float]
    deviation: float
    remarks: List[str]

    @property
    def is_same(self) -> bool:
        return self.over_ros == self.in_one_process and self.poses > 0 and self.differs_at is None


def compare(seed: int, mission: Optional[Path] = None) -> Comparison:
    """Run a mission over ROS and in one process."""
    run = over_ros(seed, mission)
    first, exact = (
        in_one_process(seed, mission, run.mission_start, encoding)
        for encoding in (MessageValues(), ExactValues())
    )
    pairs = _pairs(run, first)
    differing = [stamp for stamp, ours, theirs in pairs if ours != theirs]
    distances = [np.hypot(a[0] - b[0], a[1] - b[1]) for _, a, b in _pairs(run, exact)]
    return Comparison(
        decisions(run.findings),
        decisions(first.mission_record.result_fields()),
        len(pairs),
        differing[0] / 1e3 if differing else None,
        float(max(distances)),
        run.findings["not_repeatable_because"],
    )


def in_one_process(seed: int, mission: Optional[Path], start: float, encoding: Encoding) -> EpisodeResult:
    home = read_mission(Rehearse(seed=seed, mission=mission))
    parcel = None if mission else parcel_for(home.mission)
    conditions = EpisodeConditions(mission_start=start, encoding=encoding)
    stage = home.world, home.robot, home.grid, home.mission
    return HeadlessMission(*stage, seed=seed, parcel=parcel, conditions=conditions).run()


def over_ros(seed: int, mission: Optional[Path]) -> RosRun:
    with tempfile.TemporaryDirectory() as parent:
        options = ["--seed", str(seed), "--output", parent]
        options += [] if mission is None else ["--mission", str(mission)]
        command = [str(ROOT / "scripts/home_service.sh"), *options]
        subprocess.run(command, stdout=subprocess.DEVNULL, check=False, timeout=SCRIPT_SECONDS)
        folder = next(Path(parent).iterdir())
        findings = json.loads((folder / "result.json").read_text(encoding="utf-8"))
        trace = [line.split() for line in (folder / "trace.txt").read_text(encoding="utf-8").splitlines()]
    accepted = next(float(row[0]) for row in trace if row[1] == GOAL)
    poses = {_ms(float(row[0])): [float(value) for value in row[3:7]] for row in trace if row[1] == TRUTH}
    return RosRun(findings, accepted - LATENCY, poses)


def _pairs(run: RosRun, episode: EpisodeResult):
    """Stamp [ms] and true x, y, z, w in one process and over ROS at each control period with both."""
    found = [
        (_ms(stamp), [x, y, *quaternion_zw(yaw)], run.poses.get(_ms(stamp)))
        for stamp, x, y, yaw in episode.trajectory.tolist()
    ]
    return [pair for pair in found if pair[2] is not None]


def _ms(stamp: float) -> int:
    return round(1e3 * stamp)


def decisions(findings: Dict[str, Any]) -> List[str]:
    """Final state and attempts of each delivery, and the marker events of the errand."""
    jobs = [f"{job['name']}: {job['state']}, attempts {job['attempts']}" for job in findings["deliveries"]]
    return [*sorted(jobs), *(findings["markers"] if len(jobs) == 1 else []), findings["final_state"]]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, nargs="+", default=[42, 43, 44], help="default: 42 43 44")
    parser.add_argument("--mission", type=Path, help="mission file instead of the errand", metavar="FILE")
    options = parser.parse_args()
    print("seed  decisions  true poses with the same bits     largest distance with exact values, m")
    all_same = True
    for seed in options.seeds:
        found = compare(seed, options.mission)
        all_same &= found.is_same
        is_same = found.over_ros == found.in_one_process
        poses = f"all {found.poses}" if found.differs_at is None else f"until {found.differs_at:.2f} s"
        print(
            f"{seed:4}  {'the same' if is_same else 'DIFFERENT'}   {poses:32}  {found.deviation:.3f}",
            flush=True,
        )
        for remark in found.remarks:
            print(f"  may not be repeatable: {remark}")
        if not is_same:
            print(f"  in one process: {found.in_one_process}\n  over ROS: {found.over_ros}")
    return 0 if all_same else 1


if __name__ == "__main__":
    sys.exit(main())
