#!/usr/bin/env python3
"""Find how far from a log's corrected poses the poses are at which its scans fit best.

    python3 tests/benchmarks/slam_attainable.py LOGS/NAME.truth ...

All pairs of overlapping keyframes are matched point to line and adjusted together until nothing moves, once
from the map and once from the corrected poses (F. Lu and E. Milios, "Globally consistent range scan alignment
for environment mapping", Autonomous Robots 1997). If both end equally far from the corrected poses, no map
that fits the scans is nearer. The fit is the mean weight, 0 to 1, of points by a robust cost of 0.07 m.
"""

import argparse
import math
import sys
from pathlib import Path
from typing import List, Sequence, Tuple

import numba
import numpy as np
from rich.console import Console
from rich.table import Table
from slam import aligned_errors

from planar import Pose2
from planar_ros.bags.scan_log import ScanLog
from planar_ros.node.entry import use_one_blas_thread
from slam_lite.config import NodeSettings
from slam_lite.graph.pose_graph import COARSE, Edges, optimize
from slam_lite.mapper import Mapper
from slam_lite.point_cloud import PointCloud

# Distance of two keyframes that are matched [m], and number of others that each is matched to.
MAX_DISTANCE, NEIGHBOURS = 10.0, 30
# Distance [m] and cosine of normals up to which points are paired; first and last scale of the cost [m].
MAX_PAIR_DISTANCE, SAME_WALL, FIRST_SCALE, LAST_SCALE = 0.3, 0.5, 0.3, 0.07
STEPS, MIN_POINTS, SIGMA = 15, 20, 0.1


class Scans:
    """Points of all keyframes in one array each, for the kernel."""

    def __init__(self, clouds: Sequence[PointCloud]):
        self.points = np.concatenate([cloud.points_xy for cloud in clouds]).astype(np.float64)
        self.normals = np.concatenate([cloud.normals_xy for cloud in clouds]).astype(np.float64)
        self.starts = np.concatenate(([0], np.cumsum([len(cloud) for cloud in clouds])))

    def match(self, poses: np.ndarray, pairs: np.ndarray, scale: float) -> Tuple[Edges, float]:
        """Return the measured pose of each pair, and the fit at the given poses."""
        information, measured, weights, counts = _match_pairs(
            self.points, self.normals, self.starts, poses, pairs, scale
        )
        enough = weights > MIN_POINTS
        edges = Edges(
            pairs[enough], measured[enough], information[enough] / SIGMA**2, np.zeros(enough.sum(), bool)
        )
        return edges, float(weights.sum() / max(counts.sum(), 1))

    def fit(self, poses: np.ndarray) -> float:
        """The mean weight of all matched points."""
        return self.match(poses, pairs_near(poses), LAST_SCALE)[1]

    def adjusted(self, poses: np.ndarray) -> np.ndarray:
        """The poses (N, 3) at which the scans fit best."""
        pairs = pairs_near(poses)
        for step in range(STEPS):
            edges, _ = self.match(poses, pairs, max(LAST_SCALE, FIRST_SCALE * 0.5**step))
            before, poses = poses, optimize(poses, edges, COARSE)
            if np.abs(poses - before)[:, :2].max() < 1e-3:
                break
        return poses


def pairs_near(poses: np.ndarray) -> np.ndarray:
    """Pairs (P, 2) of keyframes that are near each other."""
    pairs: List[Tuple[int, int]] = []
    for i in range(len(poses)):
        distances = np.hypot(*(poses[:, :2] - poses[i, :2]).T)
        near = [int(j) for j in np.argsort(distances)[: NEIGHBOURS + 1] if distances[j] < MAX_DISTANCE]
        pairs += [(j, i) for j in near if j != i]
    return np.array(pairs)


@numba.njit(cache=True)
def _match_pairs(points, normals, starts, poses, pairs, scale):
    """One step of point-to-line matching of each pair's second scan to its first."""
    information, measured = np.zeros((len(pairs), 3, 3)), np.zeros((len(pairs), 3))
    weights, counts = np.zeros(len(pairs)), np.zeros(len(pairs))
    for e in range(len(pairs)):
        j, i = pairs[e, 0], pairs[e, 1]
        cj, sj = math.cos(poses[j, 2]), math.sin(poses[j, 2])
        dx, dy, yaw = poses[i, 0] - poses[j, 0], poses[i, 1] - poses[j, 1], poses[i, 2] - poses[j, 2]
        x, y, c, s = cj * dx + sj * dy, cj * dy - sj * dx, math.cos(yaw), math.sin(yaw)
        gradient, jacobian = np.zeros(3), np.zeros(3)
        for p in range(starts[i], starts[i + 1]):
            rx, ry = c * points[p, 0] - s * points[p, 1], s * points[p, 0] + c * points[p, 1]
            nearest, best = -1, MAX_PAIR_DISTANCE**2
            for q in range(starts[j], starts[j + 1]):
                squared = (points[q, 0] - x - rx) ** 2 + (points[q, 1] - y - ry) ** 2
                if squared < best:
                    nearest, best = q, squared
            if nearest < 0:
                continue
            nx, ny = normals[nearest]
            mx, my = c * normals[p, 0] - s * normals[p, 1], s * normals[p, 0] + c * normals[p, 1]
            if mx * nx + my * ny < SAME_WALL:  # also where one of them has no normal
                continue
            error = (x + rx - points[nearest, 0]) * nx + (y + ry - points[nearest, 1]) * ny
            weight = 1.0 / (1.0 + (error / scale) ** 2) ** 2
            jacobian[0], jacobian[1], jacobian[2] = nx, ny, ny * rx - nx * ry
            gradient += weight * error * jacobian
            information[e] += weight * np.outer(jacobian, jacobian)
            weights[e] += weight
            counts[e] += 1.0
        step = np.linalg.solve(information[e] + np.eye(3), gradient)
        measured[e, 0], measured[e, 1], measured[e, 2] = x - step[0], y - step[1], yaw - step[2]
    return information, measured, weights, counts


def main() -> int:
    use_one_blas_thread()
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("truths", nargs="+", type=Path, metavar="TRUTH", help="NAME.truth, beside NAME.bag")
    table = Table(title="mean error, m, and fit")
    for heading in ("log", "map", "adjusted", "corrected poses adjusted", "fit of map", "of corrected poses"):
        table.add_column(heading, justify="right")
    for path in parser.parse_args().truths:
        table.add_row(path.stem, *figures_of(path))
    Console(width=120).print(table)
    return 0


def figures_of(truth_path: Path) -> Tuple[str, ...]:
    """The table's figures for one log, whose scans all have corrected poses."""
    log = ScanLog(truth_path.with_suffix(".bag"), "scan", "base_link", "odom", lambda text: None)
    mapper, stamps, laser_in_base = Mapper(NodeSettings()), [], Pose2()
    for logged in log:
        update = mapper.insert(logged.base_in_odom, logged.scan)
        if update is not None and update.is_keyframe:
            stamps.append(logged.scan.stamp)
            laser_in_base = logged.scan.laser_in_base
    mapper.run_final_optimization()
    every = np.loadtxt(truth_path)
    truth = every[np.abs(every[:, 0] - np.array(stamps)[:, None]).argmin(axis=1)]

    def error(poses: np.ndarray) -> str:
        lasers = np.array([(Pose2.from_array(pose) @ laser_in_base).as_array() for pose in poses])
        return f"{aligned_errors(np.column_stack((truth[:, 0], lasers)), truth)[0].mean():.4f}"

    poses, scans = mapper.keyframe_poses.copy(), Scans(mapper.state().clouds)
    laser_inverse = laser_in_base.inverse()
    real = np.array([(Pose2.from_array(pose) @ laser_inverse).as_array() for pose in truth[:, 1:]])
    fits = (f"{scans.fit(each):.3f}" for each in (poses, real))
    return (error(poses), error(scans.adjusted(poses)), error(scans.adjusted(real)), *fits)


if __name__ == "__main__":
    sys.exit(main())
