"""Pose hypotheses of a lost robot: poses at which its scan fits the map."""

from typing import List, Tuple

import numpy as np

from amcl_lite.filter.particles import FreeSpace
from amcl_lite.recovery.quality import scan_quality
from amcl_lite.sensor.beams import Beams
from amcl_lite.sensor.likelihood_field import LikelihoodField
from amcl_lite.sensor.scan_matching import match_scan
from amcl_lite.sensor.sensor_model import mean_fits
from planar import OCCUPIED, OccupancyGrid, Pose2

_DRAWN, _MATCHED, _KEPT = 6000, 40, 10
# Prior covariance of scan matching around a drawn pose [m, m, rad].
_PRIOR_COVARIANCE = np.diag((0.3, 0.3, 0.3)) ** 2
# Standard deviation of particles around a hypothesis [m, m, rad].
_SPREAD = np.array((0.1, 0.1, 0.05))
_MIN_PROBABILITY = 0.5
_BEAMS_FOR_RANKING = 30


class PoseHypotheses:
    """Poses (N, 3) at which a scan fits the map, sorted by decreasing probability."""

    def __init__(self, poses: np.ndarray, free_space: FreeSpace):
        self.poses = poses
        self._free_space = free_space

    def __len__(self) -> int:
        return len(self.poses)

    def draw(self, count: int, rng: np.random.Generator) -> np.ndarray:
        """Draw poses (count, 3) around the hypotheses, within free space."""
        chosen = self.poses[rng.integers(len(self.poses), size=count)]
        scattered = chosen + rng.standard_normal((count, 3)) * _SPREAD
        return np.where(self._free_space.contains(scattered)[:, None], scattered, chosen)


def find_hypotheses(
    beams: Beams,
    field: LikelihoodField,
    grid: OccupancyGrid,
    free_space: FreeSpace,
    rng: np.random.Generator,
) -> PoseHypotheses:
    """Search the map for poses at which a scan fits.

    Args:
        beams: Beams of the scan.
        field: Likelihood field of the map.
        grid: The map.
        free_space: Free cells of the map.
        rng: Source of randomness.

    Returns:
        The most probable poses after scan matching, at most _KEPT.
    """
    ends_xy = beams.ends_xy
    drawn = free_space.draw(_DRAWN, rng)
    few = ends_xy[:: max(1, len(ends_xy) // _BEAMS_FOR_RANKING)]
    best = drawn[np.argsort(-mean_fits(drawn, few, field), kind="stable")[:_MATCHED]]
    found: List[Tuple[float, Pose2]] = []
    for pose in best:
        place = match_scan(Pose2.from_array(pose), _PRIOR_COVARIANCE, ends_xy, field)
        if grid.value_at(place.x, place.y) == OCCUPIED:
            continue
        probability = scan_quality(place, beams, field, grid).probability
        if probability > _MIN_PROBABILITY and all(place.distance_to(other) > 0.2 for _, other in found):
            found.append((probability, place))
    found.sort(key=lambda pair: -pair[0])
    poses = np.array([place.as_array() for _, place in found[:_KEPT]]).reshape(-1, 3)
    return PoseHypotheses(poses, free_space)
