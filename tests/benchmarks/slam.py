#!/usr/bin/env python3
"""Score slam_lite on real logs: by hand-verified relations, or by poses that others have corrected.

R. Kuemmerle et al., "On measuring the accuracy of SLAM algorithms", Autonomous Robots 27, 2009. A relation is
the pose at one time relative to that at another; the error of a trajectory is its mean difference over all
relations. Corrected poses are compared after the best rigid alignment of both trajectories (ATE). A folder of
logs holds pairs NAME.relations (``t1 t2 x y z roll pitch yaw``) or NAME.truth (``t x y yaw``), and NAME*.bag;
each is replayed by the command slam_lite_replay; its CPU time and memory include start-up and reading.

    python3 tests/benchmarks/slam.py LOGS --out runs/slam
"""

import argparse
import json
import os
import subprocess
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import List, Optional, Tuple

import matplotlib
import numpy as np
from rich.console import Console
from rich.table import Table

from planar import FREE, OCCUPIED, load_map, wrap

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
REPLAY = ROOT / "src" / "slam_lite" / "nodes" / "slam_lite_replay"
SAME_STAMP = 1e-4


@dataclass(frozen=True)
class Score:
    """Errors of one log over all relations or corrected poses, metres and radians, and the replay's cost."""

    log: str
    kind: str
    count: int
    translation_mean: float
    translation_std: float
    rotation_mean: float
    rotation_std: float
    scans: int
    log_seconds: float
    wall_seconds: float
    cpu_seconds: float
    memory_mb: float


def main() -> int:
    options = _options()
    logs = [log for folder in options.folders for log in find_logs(folder)]
    if not logs:
        print("error: no NAME.relations or NAME.truth with a NAME*.bag in the folders", file=sys.stderr)
        return 2
    options.out.mkdir(parents=True, exist_ok=True)
    scores = [score_log(bag, reference, options.out, options.config) for bag, reference in logs]
    for _, reference in logs:  # after all replays, whose memory would otherwise include this process's
        draw(options.out / reference.stem)
    (options.out / "slam.json").write_text(json.dumps([asdict(score) for score in scores], indent=2) + "\n")
    Console(width=120).print(_table(scores))
    return 0


def find_logs(folder: Path) -> List[Tuple[Path, Path]]:
    """Pairs (bag, relations or corrected poses) of a folder, by name."""
    pairs = []
    for reference in sorted((*folder.glob("*.relations"), *folder.glob("*.truth"))):
        bags = sorted(folder.glob(reference.stem + "*.bag"))
        pairs += [(bags[0], reference)] if bags else []
    return pairs


def score_log(bag: Path, reference: Path, out: Path, config: Optional[Path] = None) -> Score:
    """Replay a bag, write its map and trajectory to ``out``, and score the trajectory."""
    stem = out / reference.stem
    tum = stem.with_suffix(".tum")
    command = [sys.executable, str(REPLAY), str(bag), "--map", str(stem), "--trajectory", str(tum)]
    start = time.monotonic()
    replay = subprocess.Popen(command + (["--config", str(config)] if config else []))
    _, status, usage = os.wait4(replay.pid, 0)
    if status != 0:
        raise SystemExit(f"error: the replay of {bag} failed")
    wall_seconds = time.monotonic() - start
    trajectory = read_trajectory(tum)
    has_relations = reference.suffix == ".relations"
    errors = relation_errors if has_relations else aligned_errors
    translation, rotation = errors(trajectory, np.loadtxt(reference))
    return Score(
        log=reference.stem,
        kind="relations" if has_relations else "poses",
        count=len(translation),
        translation_mean=float(translation.mean()),
        translation_std=float(translation.std()),
        rotation_mean=float(rotation.mean()),
        rotation_std=float(rotation.std()),
        scans=len(trajectory),
        log_seconds=float(trajectory[-1, 0] - trajectory[0, 0]),
        wall_seconds=wall_seconds,
        cpu_seconds=usage.ru_utime + usage.ru_stime,
        memory_mb=usage.ru_maxrss / 1024.0,
    )


def read_trajectory(tum: Path) -> np.ndarray:
    """Read a trajectory file: (N, 4), rows ``t x y yaw``."""
    rows = np.loadtxt(tum)
    return np.column_stack((rows[:, :3], 2.0 * np.arctan2(rows[:, 6], rows[:, 7])))


def relation_errors(trajectory: np.ndarray, relations: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Translational (metres) and rotational (radians) error of each relation.

    ``trajectory``: (N, 4), rows ``t x y yaw``; ``relations``: (M, 8), rows ``t1 t2 x y z roll pitch yaw``.
    """
    first, second = (_poses_at(trajectory, relations[:, column]) for column in (0, 1))
    estimated = _relative_poses(first, second)
    error = _relative_poses(relations[:, [2, 3, 7]], estimated)
    return np.hypot(error[:, 0], error[:, 1]), np.abs(wrap(error[:, 2]))


def aligned_errors(trajectory: np.ndarray, truth: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Translational (metres) and rotational (radians) error of each pose after the best rigid alignment.

    ``trajectory`` and ``truth``: (N, 4) and (M, 4), rows ``t x y yaw``; each stamp of ``truth`` is needed.
    """
    estimated = _poses_at(trajectory, truth[:, 0])
    (mine, real) = (rows[:, 0] + 1j * rows[:, 1] for rows in (estimated, truth[:, 1:]))
    mine, real = mine - mine.mean(), real - real.mean()
    turn = np.angle(np.vdot(mine, real))
    rotation = wrap(estimated[:, 2] + turn - truth[:, 3])
    return np.abs(mine * np.exp(1j * turn) - real), np.abs(rotation)


def _poses_at(trajectory: np.ndarray, stamps: np.ndarray) -> np.ndarray:
    rows = np.searchsorted(trajectory[:, 0], stamps - SAME_STAMP)
    found = trajectory[np.minimum(rows, len(trajectory) - 1)]
    missing = np.abs(found[:, 0] - stamps) > SAME_STAMP
    if missing.any():
        first = stamps[missing][0]
        raise SystemExit(f"error: the trajectory lacks {missing.sum()} stamps, the first is {first}")
    return found[:, 1:]


def _relative_poses(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Poses (N, 3) ``second`` in the frames of ``first``."""
    c, s = np.cos(first[:, 2]), np.sin(first[:, 2])
    dx, dy = second[:, 0] - first[:, 0], second[:, 1] - first[:, 1]
    return np.column_stack((c * dx + s * dy, c * dy - s * dx, second[:, 2] - first[:, 2]))


def draw(stem: Path) -> None:
    """Plot a map with the trajectory, as a picture beside the map."""
    trajectory = read_trajectory(stem.with_suffix(".tum"))
    grid = load_map(stem.with_name(stem.name + ".yaml"))
    shade = np.full(grid.cells.shape, 0.8)
    shade[grid.cells == FREE] = 1.0
    shade[grid.cells == OCCUPIED] = 0.0
    left, bottom = grid.origin.x, grid.origin.y
    extent = (left, left + grid.cols * grid.resolution, bottom, bottom + grid.rows * grid.resolution)
    figure, axes = plt.subplots(figsize=(12, 12.0 * grid.rows / grid.cols + 0.5))
    axes.imshow(shade, cmap="gray", vmin=0.0, vmax=1.0, origin="lower", extent=extent)
    axes.plot(trajectory[:, 1], trajectory[:, 2], color="tab:red", linewidth=0.6)
    axes.set_xlabel("x, m")
    axes.set_ylabel("y, m")
    figure.tight_layout()
    figure.savefig(stem.with_name(stem.name + ".png"), dpi=120)
    plt.close(figure)


def _table(scores: List[Score]) -> Table:
    table = Table(title="error as mean +- standard deviation")
    headings = ("log", "compared", "translation, m", "rotation, deg", "CPU, s", "wall, s", "log, s", "MB")
    for heading in headings:
        table.add_column(heading, justify="right")
    for score in scores:
        table.add_row(
            score.log,
            f"{score.count} {score.kind}",
            f"{score.translation_mean:.4f} +- {score.translation_std:.4f}",
            f"{np.degrees(score.rotation_mean):.3f} +- {np.degrees(score.rotation_std):.3f}",
            f"{score.cpu_seconds:.1f}",
            f"{score.wall_seconds:.1f}",
            f"{score.log_seconds:.0f}",
            f"{score.memory_mb:.0f}",
        )
    return table


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folders", nargs="+", type=Path, metavar="LOGS", help="folders of bags and truth")
    parser.add_argument("--out", type=Path, default=Path("runs/slam"), help="default: runs/slam")
    parser.add_argument("--config", type=Path, help="parameters of slam_gmapping, for all logs")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
