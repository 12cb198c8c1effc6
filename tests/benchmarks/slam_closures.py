#!/usr/bin/env python3
"""Count right and wrong loop closures on simulated logs, by ground truth.

    python3 tests/benchmarks/slam_closures.py repetitive --seeds 100-109
    python3 tests/benchmarks/slam_closures.py site --seeds 100-109 --json runs/closures.json

A closure is wrong if its error exceeds a metre or 0.1 rad, and also what its information allows, as along a
smooth corridor; it is harmful if the graph agrees with it. Seeds below 100 are for choosing settings, from
100 on for evaluation.
"""

import argparse
import json
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import List, Tuple

import numpy as np
from helpers.bags import START
from helpers.command_line import seeds
from helpers.drives import Observation
from slam import relation_errors
from slam_logs import DRAWN, DRIVES, relations_of, simulate

from planar import wrap
from planar_ros.node.entry import use_one_blas_thread
from slam_lite.config import NodeSettings
from slam_lite.graph.pose_graph import chi_squares
from slam_lite.mapper import Mapper
from slam_lite.scan_trajectory import ScanTrajectory

# Least error of a wrong closure: metres, radians, and standard deviations by its information.
WRONG_XY, WRONG_YAW, WRONG_SIGMAS = 1.0, 0.1, 4.0
# The graph agrees with a closure up to this chi-square.
AGREES = 10.0


@dataclass(frozen=True)
class Closures:
    """One log: its closures, the error over its relations, the CPU time of a scan. Metres, milliseconds.

    ``live``: without the search for closures, for which scans do not wait in the node.
    """

    log: str
    seed: int
    scans: int
    keyframes: int
    right: int
    wrong: int
    harmful: int
    mean_error: float
    median_error: float
    end_off: float
    farthest_off: float
    cpu_mean: float
    cpu_mean_of_last_quarter: float
    live_p99: float
    live_p99_of_last_quarter: float


def main() -> int:
    use_one_blas_thread()
    options = _options()
    results = []
    for seed in options.seeds:
        results.append(evaluate(options.log, seed))
        print(_line(results[-1]), flush=True)
    right, wrong = sum(one.right for one in results), sum(one.wrong for one in results)
    mean = np.mean([one.mean_error for one in results])
    print(f"{options.log}: {right} right closures, {wrong} wrong, mean error {mean:.3f} m")
    if options.json:
        options.json.write_text(json.dumps([asdict(one) for one in results], indent=2) + "\n")
    return 0


def evaluate(name: str, seed: int) -> Closures:
    """Map one log and compare it with the truth."""
    _, _, observations = simulate(name, seed)
    mapper, trajectory, true_keyframes, cpu_ms, live_ms = mapped(observations)
    measured, real = _closures(mapper, true_keyframes)
    off = measured - real
    off[:, 2] = wrap(off[:, 2])
    is_wrong = (np.hypot(off[:, 0], off[:, 1]) > WRONG_XY) | (np.abs(off[:, 2]) > WRONG_YAW)
    edges = mapper.state().edges
    chi = np.einsum("ni,nij,nj->n", off, edges.information[edges.is_loop], off)
    is_wrong &= chi > WRONG_SIGMAS**2
    is_agreed = chi_squares(mapper.keyframe_poses, edges)[edges.is_loop] < AGREES
    poses = trajectory.poses(mapper.keyframe_poses, of_laser=True)
    poses[:, 0] += START
    errors, _ = relation_errors(poses, relations_of(observations))
    ends = np.array([[0, len(true_keyframes) - 1]])
    end_off = _relative_poses(mapper.keyframe_poses, ends) - _relative_poses(true_keyframes, ends)
    return Closures(
        name,
        seed,
        len(observations),
        len(true_keyframes),
        right=int(np.count_nonzero(~is_wrong)),
        wrong=int(np.count_nonzero(is_wrong)),
        harmful=int(np.count_nonzero(is_wrong & is_agreed)),
        mean_error=float(errors.mean()),
        median_error=float(np.median(errors)),
        end_off=float(np.hypot(*end_off[0, :2])),
        farthest_off=float(_positions_off(mapper.keyframe_poses, true_keyframes).max()),
        cpu_mean=float(cpu_ms.mean()),
        cpu_mean_of_last_quarter=float(cpu_ms[-len(cpu_ms) // 4 :].mean()),
        live_p99=float(np.percentile(live_ms, 99)),
        live_p99_of_last_quarter=float(np.percentile(live_ms[-len(live_ms) // 4 :], 99)),
    )


def mapped(
    observations: List[Observation],
) -> Tuple[Mapper, ScanTrajectory, np.ndarray, np.ndarray, np.ndarray]:
    """Map a log.

    Returns:
        The mapper, the trajectory, the true poses (K, 3) of keyframes, and the CPU time (N,) of each scan
        [ms], with the search for closures and without.
    """
    mapper, trajectory = Mapper(NodeSettings(), deferred=True), ScanTrajectory()
    true_keyframes, cpu_ms, live_ms = [], [], []
    for observation in observations:
        start = time.process_time()
        update = mapper.insert(observation.base_in_odom, observation.scan)
        task = mapper.closure_task()
        inserted = time.process_time()
        result = None if task is None else task.run()
        found = time.process_time()
        if result is not None:
            mapper.apply_closures(result)
        end = time.process_time()
        cpu_ms.append(1000.0 * (end - start))
        live_ms.append(cpu_ms[-1] - 1000.0 * (found - inserted))
        trajectory.add(observation.base_in_odom, observation.scan, update)
        if update is not None and update.is_keyframe:
            true_keyframes.append(observation.base_in_map.as_array())
    mapper.run_final_optimization()
    return mapper, trajectory, np.array(true_keyframes), np.array(cpu_ms), np.array(live_ms)


def _closures(mapper: Mapper, true_keyframes: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The pose that each closure measured, (N, 3), and the true one."""
    edges = mapper.state().edges
    return edges.measured[edges.is_loop], _relative_poses(true_keyframes, edges.nodes[edges.is_loop])


def _relative_poses(poses: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """For pairs (N, 2) of poses (M, 3) the second one relative to the first, (N, 3)."""
    first, step = poses[pairs[:, 0]], poses[pairs[:, 1]] - poses[pairs[:, 0]]
    c, s = np.cos(first[:, 2]), np.sin(first[:, 2])
    ahead, left = c * step[:, 0] + s * step[:, 1], c * step[:, 1] - s * step[:, 0]
    return np.column_stack((ahead, left, wrap(step[:, 2])))


def _positions_off(poses: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Position errors (N,) after optimal alignment of both trajectories."""
    mine, real = (each[:, 0] + 1j * each[:, 1] for each in (poses, truth))
    mine, real = mine - mine.mean(), real - real.mean()
    turn = np.vdot(mine, real)
    return np.abs(mine * turn / np.abs(turn) - real)


def _line(one: Closures) -> str:
    return (
        f"{one.log} {one.seed}: {one.scans} scans, {one.keyframes} keyframes; "
        f"closures {one.right} right, {one.wrong} wrong "
        f"({one.harmful} agreed with); error {one.mean_error:.3f} m, median {one.median_error:.3f}, "
        f"end off {one.end_off:.2f}, keyframes off by up to {one.farthest_off:.2f}; "
        f"a scan {one.cpu_mean:.1f} ms, in the last quarter {one.cpu_mean_of_last_quarter:.1f}; "
        f"live, 99 of 100 within {one.live_p99:.1f} ms, there {one.live_p99_of_last_quarter:.1f}"
    )


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("log", choices=[*DRIVES, *DRAWN], help="which logs")
    parser.add_argument("--seeds", type=seeds, default=range(1), help="such as 100-109 (default: 0)")
    parser.add_argument("--json", type=Path, help="write the figures here")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
