"""Where the frame of a project's map lies in the world: a map of SLAM begins anywhere."""

from typing import List, Tuple

from planar import Pose2

# Distance between an estimate and the truth that is an error of localization, not another frame [m].
LARGEST_ERROR = 1.5
# Distance within which a frame explains a pair of poses [m], and the share of pairs it has to explain.
AGREEMENT, LEAST_SHARE = 0.5, 0.5
LEAST_PAIRS, MOST_PAIRS = 3, 100


class MapAlignment:
    """Determines the map's frame by pairs of estimated and true poses.

    The map is taken to be the world's, as with most projects, unless another frame explains most of the pairs
    and estimates are too far away from the truth for an error of localization.
    """

    def __init__(self) -> None:
        self._pairs: List[Tuple[Pose2, Pose2]] = []

    def add(self, estimate: Pose2, truth: Pose2) -> None:
        """Add a pose that localization estimates in the map, and the true one in the world at that time."""
        self._pairs.append((estimate, truth))
        if len(self._pairs) > MOST_PAIRS:
            del self._pairs[::2]

    def map_in_world(self) -> Pose2:
        """Pose of the map's frame in the world."""
        pairs = self._pairs
        if len(pairs) < LEAST_PAIRS:
            return Pose2()
        is_explained = sum(estimate.distance_to(truth) < LARGEST_ERROR for estimate, truth in pairs)
        frames = [truth @ estimate.inverse() for estimate, truth in pairs]
        best = max(frames, key=self._count_of_explained)
        share = self._count_of_explained(best) / len(pairs)
        return best if share >= LEAST_SHARE and is_explained < LEAST_SHARE * len(pairs) else Pose2()

    def _count_of_explained(self, frame: Pose2) -> int:
        return sum((frame @ estimate).distance_to(truth) < AGREEMENT for estimate, truth in self._pairs)
