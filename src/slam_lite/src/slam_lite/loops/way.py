"""The way that a robot has gone, as it was followed from scan to scan, whatever closures say."""

from dataclasses import dataclass
from typing import Tuple

import numpy as np

from planar import Pose2, wrap
from slam_lite.graph.drift import variances_xy
from slam_lite.graph.pose_graph import Edges, between

# A step that is less sure than this, metres, is none: the robot was put down anew, so many metres on.
_BROKEN, _FAR = 0.4, 200.0


@dataclass(frozen=True, eq=False)
class Way:
    """Keys' ``poses`` (N, 3), as the robot was followed, and the ``metres`` (N,) driven up to each."""

    poses: np.ndarray
    metres: np.ndarray

    def between(self, first: int, second: int) -> Pose2:
        return between(self.poses, first, second)

    def around(self, key: int, reach: float) -> Tuple[int, int]:
        """The first and the last key at most so many metres of way away."""
        ends = np.searchsorted(self.metres, self.metres[key] + np.array([-reach, reach]))
        return int(ends[0]), int(ends[1]) - 1

    def apart(self, first: int, second: int) -> float:
        return float(abs(self.metres[second] - self.metres[first]))


def way_of(first: np.ndarray, edges: Edges) -> Way:
    """The way of a graph whose first key is at ``first`` (3,)."""
    steps = np.flatnonzero(~edges.is_loop)
    steps = steps[np.argsort(edges.nodes[steps, 1])]
    measured = edges.measured[steps]
    yaw = np.concatenate((first[2:], first[2] + np.cumsum(measured[:, 2])))
    c, s = np.cos(yaw[:-1]), np.sin(yaw[:-1])
    x, y = measured[:, 0], measured[:, 1]
    moves = np.column_stack((c * x - s * y, s * x + c * y))
    is_broken = variances_xy(edges)[steps] > _BROKEN**2
    lengths = np.where(is_broken, _FAR, np.hypot(x, y))
    xy = np.vstack((first[:2], first[:2] + np.cumsum(moves, axis=0)))
    return Way(np.column_stack((xy, wrap(yaw))), np.concatenate(([0.0], np.cumsum(lengths))))
