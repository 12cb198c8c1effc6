"""Where a lost robot may be: the places of the map that its scan fits."""

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
# How far a drawn pose may be from the place that scan matching pulls it to: metres, metres, radians.
_REACH = np.diag((0.3, 0.3, 0.3)) ** 2
# Particles are strewn this far about a hypothesis.
_SPREAD = np.array((0.1, 0.1, 0.05))
_BELIEVABLE = 0.5
_BEAMS_TO_DRAW_BY = 30


class PoseHypotheses:
    """Some poses at which a scan fits the map, better ones first; ``poses``: (N, 3)."""

    def __init__(self, poses: np.ndarray, free_space: FreeSpace):
        self.poses = poses
        self._free_space = free_space

    def __len__(self) -> int:
        return len(self.poses)

    def draw(self, count: int, rng: np.random.Generator) -> np.ndarray:
        """Poses (count, 3) strewn about the hypotheses, as far as a robot can be there."""
        chosen = self.poses[rng.integers(len(self.poses), size=count)]
        strewn = chosen + rng.standard_normal((count, 3)) * _SPREAD
        return np.where(self._free_space.contains(strewn)[:, None], strewn, chosen)


def find_hypotheses(
    beams: Beams,
    field: LikelihoodField,
    grid: OccupancyGrid,
    free_space: FreeSpace,
    rng: np.random.Generator,
) -> PoseHypotheses:
    """Draws poses from the free space, pulls the best by scan matching, keeps those that are believable."""
    ends_xy = beams.ends_xy
    drawn = free_space.draw(_DRAWN, rng)
    few = ends_xy[:: max(1, len(ends_xy) // _BEAMS_TO_DRAW_BY)]
    best = drawn[np.argsort(-mean_fits(drawn, few, field), kind="stable")[:_MATCHED]]
    found: List[Tuple[float, Pose2]] = []
    for pose in best:
        place = match_scan(Pose2.from_array(pose), _REACH, ends_xy, field)
        if grid.value_at(place.x, place.y) == OCCUPIED:
            continue
        probability = scan_quality(place, beams, field, grid).probability
        if probability > _BELIEVABLE and all(place.distance_to(other) > 0.2 for _, other in found):
            found.append((probability, place))
    found.sort(key=lambda pair: -pair[0])
    poses = np.array([place.as_array() for _, place in found[:_KEPT]]).reshape(-1, 3)
    return PoseHypotheses(poses, free_space)
