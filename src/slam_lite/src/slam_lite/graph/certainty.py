"""How surely a graph knows where one of its nodes lies."""

import math
from typing import Optional

import numpy as np
from scipy.sparse.linalg import SuperLU

from planar import wrap
from slam_lite.graph.drift import on_average
from slam_lite.graph.pose_graph import Edge, Edges, between, factors_of, normal_equations


class Certainty:
    """Where a node lies as seen from others, by all that a settled graph knows, loops included.

    After M. Kaess and F. Dellaert, "Covariance recovery from a square root information matrix for data
    association", Robotics and Autonomous Systems 2009.
    """

    def __init__(self, poses: np.ndarray, edges: Edges, node: int):
        """``poses``: (N, 3)."""
        self._poses, self._edges, self._node = poses, edges, node
        self._others = np.delete(np.arange(3 * len(poses)), np.arange(3 * node, 3 * node + 3))
        self._factors: Optional[SuperLU] = None

    def is_surprised_by(self, edge: Edge, bound: float) -> bool:
        """Whether an edge to the node, not of the graph, is off by more than a chi-square of three degrees
        of freedom, with its own errors and the graph's.
        """
        error = edge.second_in_first.as_array() - between(self._poses, edge.first, self._node).as_array()
        error[2] = wrap(error[2])
        if error @ edge.information @ error <= bound:  # with its own errors alone
            return False
        # The inverse of the sum of both covariances; that of an edge that slides is infinite.
        shared = np.eye(3) + self._covariance_from(edge.first) @ edge.information
        return bool(error @ edge.information @ np.linalg.solve(shared, error) > bound)

    def _covariance_from(self, first: int) -> np.ndarray:
        """Of the node seen from another one, (3, 3), along the latter's axes."""
        x, y, yaw = self._poses[first]
        c, s = math.cos(yaw), math.sin(yaw)
        dx, dy = self._poses[self._node, :2] - (x, y)
        # What the other one's error, in the map, is seen as from there.
        seen = np.array([[-c, -s, c * dy - s * dx], [s, -c, -s * dy - c * dx], [0.0, 0.0, -1.0]])
        return seen @ self._covariance_of(first) @ seen.T

    def _covariance_of(self, other: int) -> np.ndarray:
        """Of another node, (3, 3), along the map's axes, if the node stays where it is."""
        if self._factors is None:
            matrix, _ = normal_equations(self._poses, on_average(self._edges))
            matrix = matrix[self._others][:, self._others]
            self._factors = factors_of(matrix)
        rows = np.searchsorted(self._others, np.arange(3 * other, 3 * other + 3))
        sides = np.zeros((len(self._others), 3))
        sides[rows, range(3)] = 1.0
        return self._factors.solve(sides)[rows]
