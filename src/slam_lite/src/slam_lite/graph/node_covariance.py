"""Covariance of a graph node relative to others."""

import math
from typing import Optional

import numpy as np
from scipy.sparse.linalg import SuperLU

from planar import wrap
from slam_lite.graph.drift import with_average_slip
from slam_lite.graph.pose_graph import Edge, Edges, factorize, normal_equations, relative_pose


class NodeCovariance:
    """Covariance of one node relative to others, from all edges of an optimized graph including loop edges.

    After M. Kaess and F. Dellaert, "Covariance recovery from a square root information matrix for data
    association", Robotics and Autonomous Systems 2009.
    """

    def __init__(self, poses: np.ndarray, edges: Edges, node: int):
        """Set the graph; it is factorized on first use.

        Args:
            poses: (N, 3), optimized poses of the nodes in the map frame.
            edges: Edges of the graph.
            node: Index of the node.
        """
        self._poses, self._edges, self._node = poses, edges, node
        self._others = np.delete(np.arange(3 * len(poses)), np.arange(3 * node, 3 * node + 3))
        self._factors: Optional[SuperLU] = None

    def is_outlier(self, edge: Edge, max_chi_square: float) -> bool:
        """Check whether a new edge to the node is inconsistent with the graph.

        The squared error is weighted by the sum of the edge's covariance and that of the graph.

        Args:
            edge: Edge whose ``second`` is the node; not part of the graph.
            max_chi_square: Largest chi-square of a consistent edge, with 3 degrees of freedom.

        Returns:
            Whether the edge exceeds ``max_chi_square``.
        """
        estimated = relative_pose(self._poses, edge.first, self._node)
        error = edge.second_in_first.as_array() - estimated.as_array()
        error[2] = wrap(error[2])
        if error @ edge.information @ error <= max_chi_square:  # by the edge's covariance alone
            return False
        # The inverse of the sum of both covariances; that of a degenerate edge is infinite.
        total = np.eye(3) + self._covariance_in(edge.first) @ edge.information
        return bool(error @ edge.information @ np.linalg.solve(total, error) > max_chi_square)

    def _covariance_in(self, first: int) -> np.ndarray:
        """Covariance (3, 3) of the node relative to another one, along the latter's axes."""
        x, y, yaw = self._poses[first]
        c, s = math.cos(yaw), math.sin(yaw)
        dx, dy = self._poses[self._node, :2] - (x, y)
        # Derivative of the node's relative pose by the other node's pose in the map.
        jacobian = np.array([[-c, -s, c * dy - s * dx], [s, -c, -s * dy - c * dx], [0.0, 0.0, -1.0]])
        return jacobian @ self._covariance_of(first) @ jacobian.T

    def _covariance_of(self, other: int) -> np.ndarray:
        """Covariance (3, 3) of another node, along the map's axes, with the node fixed."""
        if self._factors is None:
            matrix, _ = normal_equations(self._poses, with_average_slip(self._edges))
            matrix = matrix[self._others][:, self._others]
            self._factors = factorize(matrix)
        rows = np.searchsorted(self._others, np.arange(3 * other, 3 * other + 3))
        sides = np.zeros((len(self._others), 3))
        sides[rows, range(3)] = 1.0
        return self._factors.solve(sides)[rows]
