"""Sparse pose-graph optimisation with robust loop edges.

G. Grisetti et al., "A tutorial on graph-based SLAM", IEEE ITS Magazine 2010 (Gauss-Newton on the sparse
normal equations); P. Agarwal et al., "Robust map optimization using dynamic covariance scaling", ICRA 2013.
"""

from dataclasses import dataclass
from typing import Optional

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from planar import Pose2, wrap

_MAX_STEPS = 20
# Phi of dynamic covariance scaling: the chi-square of a loop edge at which its influence starts to fade.
_FREE_CHI_SQUARE = 10.0


@dataclass(frozen=True, eq=False)
class Edge:
    """A measurement of node ``second``'s pose in node ``first``'s frame.

    ``information``: (3, 3), of x, y, yaw along first's axes. ``is_loop``: it may be wrong, and is weighed
    robustly.
    """

    first: int
    second: int
    second_in_first: Pose2
    information: np.ndarray
    is_loop: bool = False


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges as arrays: ``nodes`` (E, 2), ``measured`` (E, 3), ``information`` (E, 3, 3), ``is_loop`` (E,)."""

    nodes: np.ndarray
    measured: np.ndarray
    information: np.ndarray
    is_loop: np.ndarray

    def __len__(self) -> int:
        return len(self.nodes)


class EdgeList:
    """A list of edges that only grows, kept as arrays; what it has given out does not change."""

    def __init__(self, edges: Optional[Edges] = None) -> None:
        self._arrays = edges or Edges(
            np.empty((0, 2), dtype=np.int64),
            np.empty((0, 3)),
            np.empty((0, 3, 3)),
            np.empty(0, dtype=bool),
        )
        self._count = len(self._arrays)

    def __len__(self) -> int:
        return self._count

    def append(self, edge: Edge) -> None:
        """Adds one edge."""
        i, arrays = self._count, self._arrays
        if i == len(arrays):
            self._arrays = arrays = Edges(*(_room(array, 2 * i + 64) for array in vars(arrays).values()))
        arrays.nodes[i] = edge.first, edge.second
        arrays.measured[i] = edge.second_in_first.as_array()
        arrays.information[i] = edge.information
        arrays.is_loop[i] = edge.is_loop
        self._count += 1

    def view(self) -> Edges:
        """The edges so far."""
        return Edges(*(array[: self._count] for array in vars(self._arrays).values()))


def edges_of(*edges: Edge) -> Edges:
    """Some edges as arrays."""
    table = EdgeList()
    for edge in edges:
        table.append(edge)
    return table.view()


def optimise(poses: np.ndarray, edges: Edges, tolerance: float) -> np.ndarray:
    """Poses (N, 3) that agree best with the edges, starting from ``poses``; node 0 stays where it is.

    Levenberg-Marquardt; ends when no pose moves more than ``tolerance`` (metres, radians) in a step.
    """
    if len(edges) == 0:
        return poses.copy()
    damping, cost = 0.0, _cost(poses, edges)
    for _ in range(_MAX_STEPS):
        step = _step(poses, edges, damping)
        moved = poses + step
        moved_cost = _cost(moved, edges)
        if moved_cost > cost:
            damping = max(10.0 * damping, 1e-4)
            if np.abs(step).max() < tolerance:
                break
            continue
        poses, cost, damping = moved, moved_cost, 0.1 * damping
        if np.abs(step).max() < tolerance:
            break
    return np.column_stack((poses[:, :2], wrap(poses[:, 2])))


def chi_squares(poses: np.ndarray, edges: Edges) -> np.ndarray:
    """How badly each edge is met: its squared error weighted by its information, (E,)."""
    errors = _errors(poses, edges)
    return np.einsum("ei,eij,ej->e", errors, edges.information, errors)


def _room(array: np.ndarray, rows: int) -> np.ndarray:
    larger = np.empty((rows, *array.shape[1:]), dtype=array.dtype)
    larger[: len(array)] = array
    return larger


def _cost(poses: np.ndarray, edges: Edges) -> float:
    chi = chi_squares(poses, edges)
    phi = _FREE_CHI_SQUARE
    faded = phi * (3.0 * chi - phi) / (chi + phi)
    return float(np.sum(np.where(edges.is_loop & (chi > phi), faded, chi)))


def _errors(poses: np.ndarray, edges: Edges) -> np.ndarray:
    first, second = poses[edges.nodes[:, 0]], poses[edges.nodes[:, 1]]
    c, s = np.cos(first[:, 2]), np.sin(first[:, 2])
    dx, dy = second[:, 0] - first[:, 0], second[:, 1] - first[:, 1]
    predicted = np.column_stack((c * dx + s * dy, -s * dx + c * dy, second[:, 2] - first[:, 2]))
    errors = predicted - edges.measured
    errors[:, 2] = wrap(errors[:, 2])
    return errors


def _step(poses: np.ndarray, edges: Edges, damping: float) -> np.ndarray:
    """One Gauss-Newton step (N, 3) with loop edges weighed by how well they are met."""
    nodes, n = edges.nodes, len(poses)
    errors = _errors(poses, edges)
    chi = np.einsum("ei,eij,ej->e", errors, edges.information, errors)
    scale = np.where(edges.is_loop, np.minimum(1.0, 2.0 * _FREE_CHI_SQUARE / (_FREE_CHI_SQUARE + chi)), 1.0)
    jacobians = _jacobians(poses, edges)
    weighted = jacobians.transpose(0, 1, 3, 2) @ (edges.information * (scale**2)[:, None, None])[:, None]
    blocks = weighted[:, :, None] @ jacobians[:, None]
    gradient = np.zeros((n, 3))
    np.add.at(gradient, nodes, np.einsum("enij,ej->eni", weighted, errors))
    offsets = np.arange(3)
    rows = (3 * nodes)[:, :, None, None, None] + offsets[:, None]
    cols = (3 * nodes)[:, None, :, None, None] + offsets
    rows, cols = np.broadcast_arrays(rows, cols)
    matrix = coo_matrix((blocks.ravel(), (rows.ravel(), cols.ravel())), shape=(3 * n, 3 * n)).tocsc()
    matrix = matrix[3:, 3:]
    matrix.setdiag(matrix.diagonal() * (1.0 + damping) + 1e-9)
    factors = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return np.vstack((np.zeros((1, 3)), -factors.solve(gradient[1:].ravel()).reshape(-1, 3)))


def _jacobians(poses: np.ndarray, edges: Edges) -> np.ndarray:
    """Derivatives (E, 2, 3, 3) of each edge's error by the poses of its two nodes."""
    first, second = poses[edges.nodes[:, 0]], poses[edges.nodes[:, 1]]
    c, s = np.cos(first[:, 2]), np.sin(first[:, 2])
    dx, dy = second[:, 0] - first[:, 0], second[:, 1] - first[:, 1]
    jacobians = np.zeros((len(first), 2, 3, 3))
    jacobians[:, 0, 0, 0], jacobians[:, 0, 0, 1], jacobians[:, 0, 0, 2] = -c, -s, -s * dx + c * dy
    jacobians[:, 0, 1, 0], jacobians[:, 0, 1, 1], jacobians[:, 0, 1, 2] = s, -c, -c * dx - s * dy
    jacobians[:, 0, 2, 2] = -1.0
    jacobians[:, 1, 0, 0], jacobians[:, 1, 0, 1] = c, s
    jacobians[:, 1, 1, 0], jacobians[:, 1, 1, 1] = -s, c
    jacobians[:, 1, 2, 2] = 1.0
    return jacobians
