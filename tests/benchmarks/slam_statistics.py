#!/usr/bin/env python3
"""Compare real logs with generated ones by the statistics that decide whether loops close.

    python3 tests/benchmarks/slam_statistics.py --bags LOGS/*.bag --generated hedges:0 site:0 corridors:0

A generated log is named by ``slam_logs.py``'s log and seed. All figures are medians: of the points that every
other scan of a segment sees through at one and the same pose (own conflict), of the shares of a scan's points
beyond 15 m and without a surface normal, of the step and the turn between keyframes, and of odometry's error
over 100 keyframes, as a share of the path.
"""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import List, Sequence, Tuple

import numpy as np
from rich.console import Console
from rich.table import Table
from slam_logs import simulate

from planar import Pose2, Scan
from planar_ros.bags.scan_log import ScanLog
from planar_ros.node.entry import use_one_blas_thread
from slam_lite.config import NodeSettings
from slam_lite.graph.pose_graph import relative_pose
from slam_lite.loops.visibility import merged_walls, seen_through_fraction
from slam_lite.mapper import Mapper

FAR = 15.0
# Keyframes of a segment, and from one segment to the next; keyframes over which odometry is compared.
SEGMENT, SEGMENT_STEP, ODOMETRY_SPAN = 20, 40, 100

OdometryScan = Tuple[Pose2, Scan]


@dataclass(frozen=True)
class Statistics:
    """Medians of one log: shares from 0 to 1, metres, radians."""

    log: str
    scans: int
    beams: int
    own_conflict: float
    far_share: float
    no_line_share: float
    step: float
    turn: float
    odometry_error: float


def main() -> int:
    use_one_blas_thread()
    options = _options()
    rows = [statistics_of(bag.stem, _read(bag)) for bag in options.bags]
    for name in options.generated:
        log, seed = name.split(":")
        _, _, observations = simulate(log, int(seed))
        rows.append(statistics_of(name, [(each.base_in_odom, each.scan) for each in observations]))
    Console(width=120).print(_table(rows))
    return 0


def statistics_of(name: str, scans: Sequence[OdometryScan]) -> Statistics:
    """Map a log, and compute its statistics at the poses that result."""
    mapper, odometry = Mapper(NodeSettings()), []
    for base_in_odom, scan in scans:
        update = mapper.insert(base_in_odom, scan)
        if update is not None and update.is_keyframe:
            odometry.append(base_in_odom.as_array())
    mapper.run_final_optimization()
    poses, clouds = mapper.keyframe_poses, mapper.state().clouds
    motions = [relative_pose(poses, i - 1, i) for i in range(1, len(poses))]
    conflicts = []
    for start in range(0, max(1, len(poses) - SEGMENT), SEGMENT_STEP):
        keyframes = range(start, min(start + SEGMENT, len(poses)))
        segment = [(clouds[i], relative_pose(poses, start, i)) for i in keyframes]
        conflicts.append(seen_through_fraction(merged_walls(segment[::2]), segment[1::4]))
    return Statistics(
        name,
        scans=len(scans),
        beams=len(scans[0][1].ranges),
        own_conflict=float(np.median(conflicts)),
        far_share=_median([np.mean(np.hypot(*cloud.points_xy.T) > FAR) for cloud in clouds if len(cloud)]),
        no_line_share=_median([np.mean(~cloud.normals_xy.any(axis=1)) for cloud in clouds if len(cloud)]),
        step=_median([np.hypot(motion.x, motion.y) for motion in motions]),
        turn=_median([abs(motion.yaw) for motion in motions]),
        odometry_error=_odometry_error(poses, np.array(odometry), motions),
    )


def _odometry_error(poses: np.ndarray, odometry: np.ndarray, motions: Sequence[Pose2]) -> float:
    """Median error of odometry's position over a span of keyframes, as a share of the path."""
    travelled = np.concatenate(([0.0], np.cumsum([np.hypot(motion.x, motion.y) for motion in motions])))
    shares = []
    for first in range(0, len(poses) - ODOMETRY_SPAN, ODOMETRY_SPAN // 2):
        last = first + ODOMETRY_SPAN
        mapped, odometric = (relative_pose(each, first, last) for each in (poses, odometry))
        shares.append(mapped.distance_to(odometric) / max(travelled[last] - travelled[first], 1e-3))
    return _median(shares)


def _median(values: Sequence[float]) -> float:
    return float(np.median(values)) if len(values) else float("nan")


def _read(bag: Path) -> List[OdometryScan]:
    log = ScanLog(bag, "scan", "base_link", "odom", lambda text: print(text, file=sys.stderr))
    return [(logged.base_in_odom, logged.scan) for logged in log]


def _table(rows: Sequence[Statistics]) -> Table:
    table = Table(title="medians")
    headings = ("log", "scans", "beams", "own conflict", "beyond 15 m", "no line", "step, m", "turn, rad")
    for heading in (*headings, "odometry error"):
        table.add_column(heading, justify="right")
    for row in rows:
        shares = (f"{share:.3f}" for share in (row.own_conflict, row.far_share, row.no_line_share))
        motion = (f"{row.step:.2f}", f"{row.turn:.3f}", f"{row.odometry_error:.1%}")
        table.add_row(row.log, str(row.scans), str(row.beams), *shares, *motion)
    return table


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bags", nargs="*", type=Path, default=[], metavar="BAG", help="real logs")
    parser.add_argument("--generated", nargs="*", default=[], metavar="LOG:SEED", help="logs of slam_logs.py")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
