"""The trajectory of the front end: keyframe poses chained from scan matching, without loop closures."""

from dataclasses import dataclass
from typing import Tuple

import numpy as np

from planar import Pose2, wrap
from slam_lite.graph.drift import variances_xy
from slam_lite.graph.pose_graph import Edges, relative_pose

# Standard deviation [m] above which a step means that the robot was carried, and the path length [m] that is
# assumed for such a step.
_BREAK_SIGMA, _BREAK_LENGTH = 0.4, 200.0


@dataclass(frozen=True, eq=False)
class TrackedTrajectory:
    """Keyframe poses along the path of the robot.

    Attributes:
        poses: (N, 3), poses in the track frame, rows ``[x, y, yaw]``.
        travelled: (N,), path length up to each keyframe [m].
    """

    poses: np.ndarray
    travelled: np.ndarray

    def between(self, first: int, second: int) -> Pose2:
        """Return the pose of keyframe ``second`` in keyframe ``first``."""
        return relative_pose(self.poses, first, second)

    def within(self, keyframe: int, reach: float) -> Tuple[int, int]:
        """Find the keyframes near another one along the path.

        Args:
            keyframe: Index of the keyframe.
            reach: Largest path length to each side [m].

        Returns:
            Indices of the first and the last keyframe.
        """
        ends = np.searchsorted(self.travelled, self.travelled[keyframe] + np.array([-reach, reach]))
        return int(ends[0]), int(ends[1]) - 1

    def path_length(self, first: int, second: int) -> float:
        """Path length between two keyframes [m]."""
        return float(abs(self.travelled[second] - self.travelled[first]))


def tracked_trajectory(first: np.ndarray, edges: Edges) -> TrackedTrajectory:
    """Chain the steps of a graph.

    Args:
        first: (3,), pose of the first keyframe, ``[x, y, yaw]``.
        edges: Edges of the graph, of which loop edges are ignored.
    """
    steps = np.flatnonzero(~edges.is_loop)
    steps = steps[np.argsort(edges.nodes[steps, 1])]
    measured = edges.measured[steps]
    yaw = np.concatenate((first[2:], first[2] + np.cumsum(measured[:, 2])))
    c, s = np.cos(yaw[:-1]), np.sin(yaw[:-1])
    x, y = measured[:, 0], measured[:, 1]
    moves = np.column_stack((c * x - s * y, s * x + c * y))
    is_break = variances_xy(edges)[steps] > _BREAK_SIGMA**2
    lengths = np.where(is_break, _BREAK_LENGTH, np.hypot(x, y))
    xy = np.vstack((first[:2], first[:2] + np.cumsum(moves, axis=0)))
    return TrackedTrajectory(np.column_stack((xy, wrap(yaw))), np.concatenate(([0.0], np.cumsum(lengths))))
