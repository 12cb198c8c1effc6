"""A scan matcher: each point is matched to the nearest one of the map (Besl and McKay, 1992: ICP).

The weight of a pair falls with its distance; odometry is a prior with its information.
"""

from typing import Tuple

import numpy as np

from planar import Pose2
from slam_lite.config import MapperSettings
from slam_lite.matching.local_map import LocalMap, Match
from slam_lite.matching.scan_matcher import Prediction
from slam_lite.point_cloud import PointCloud

STEPS, CONVERGED = 30, 1e-4
# Distances of a pair [m]: at which its weight is a quarter, up to which it counts for the response, and its
# standard deviation.
OUTLIER, PAIRED, SIGMA = 0.1, 0.1, 0.05


class ClosestPoints:
    """Scan matcher by iterated closest points, with odometry as a prior (slam_lite.matching.scan_matcher).

    Args:
        settings: Not used.
    """

    def __init__(self, settings: MapperSettings):
        pass

    def match(self, cloud: PointCloud, local_map: LocalMap, prediction: Prediction) -> Match:
        """Match a scan to a map.

        Args:
            cloud: Points of the scan in the base frame.
            local_map: Points of the map, with the index of the nearest one for each cell.
            prediction: Pose of the base by odometry, and its information (3, 3).

        Returns:
            Pose of the base, its information (3, 3), and the fraction of the points that are paired.
        """
        predicted = local_map.to_grid(prediction.base_pose)
        pose = predicted.copy()
        for _ in range(STEPS):
            information, gradient, _ = _linearize(cloud, local_map, pose)
            to_prior = prediction.information @ (predicted - pose)
            step = np.linalg.solve(information + prediction.information, gradient + to_prior)
            pose += step
            if np.abs(step).max() < CONVERGED:
                break
        information, _, response = _linearize(cloud, local_map, pose)
        return Match(local_map.from_grid(pose), information + prediction.information, response)


def _linearize(
    cloud: PointCloud, local_map: LocalMap, pose: np.ndarray
) -> Tuple[np.ndarray, np.ndarray, float]:
    """Information (3, 3) and gradient (3,) of all pairs, and the fraction of the points that are paired."""
    arms = Pose2(0.0, 0.0, pose[2]).transform_points(cloud.points_xy.astype(float))
    points_xy = arms + pose[:2]
    cells = np.floor(points_xy / local_map.resolution).astype(int)
    inside = ((cells >= 0) & (cells < len(local_map.nearest))).all(axis=1)
    nearest = local_map.nearest[cells[inside, 1], cells[inside, 0]]
    arms, nearest, points_xy = (
        arms[inside][nearest >= 0],
        nearest[nearest >= 0],
        points_xy[inside][nearest >= 0],
    )
    apart = local_map.points_xy[nearest] - points_xy
    squared = (apart**2).sum(axis=1)
    weights = (1.0 + squared / OUTLIER**2) ** -2 / SIGMA**2
    # Jacobians of the points by x, y and yaw of the base.
    moves = np.zeros((len(arms), 2, 3))
    moves[:, 0, 0] = moves[:, 1, 1] = 1.0
    moves[:, 0, 2], moves[:, 1, 2] = -arms[:, 1], arms[:, 0]
    information = np.einsum("n,nij,nik->jk", weights, moves, moves)
    gradient = np.einsum("n,nij,ni->j", weights, moves, apart)
    return information, gradient, float((squared < PAIRED**2).sum() / max(len(cloud), 1))
