"""Sparse pose-graph optimisation with robust loop edges.

G. Grisetti et al., "A tutorial on graph-based SLAM", IEEE ITS Magazine 2010 (Gauss-Newton on the sparse
normal equations); P. Agarwal et al., "Robust map optimization using dynamic covariance scaling", ICRA 2013.
"""

import math
from dataclasses import dataclass
from typing import Optional, Tuple

import numba
import numpy as np
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import SuperLU, splu

from planar import Pose2, wrap

_MAX_STEPS = 20
# Phi of dynamic covariance scaling: the chi-square of a loop edge at which its influence starts to fade.
_FREE_CHI_SQUARE = 10.0
# From this one on it has as good as none.
_FADED_CHI_SQUARE = 100.0
# A new edge's influence is narrowed down by this factor at a time.
_RELAXATION = 0.1


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

    def __getitem__(self, number: int) -> Edge:
        first, second = (int(node) for node in self.nodes[number])
        measured = Pose2.from_array(self.measured[number])
        return Edge(first, second, measured, self.information[number], bool(self.is_loop[number]))


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


def between(poses: np.ndarray, first: int, second: int) -> Pose2:
    """One of ``poses`` (N, 3) as seen from another."""
    return Pose2.from_array(poses[first]).inverse() @ Pose2.from_array(poses[second])


def edges_of(*edges: Edge) -> Edges:
    """Some edges as arrays."""
    table = EdgeList()
    for edge in edges:
        table.append(edge)
    return table.view()


def optimise(poses: np.ndarray, edges: Edges, tolerance: float, fresh: int = 0) -> np.ndarray:
    """Poses (N, 3) that agree best with the edges, starting from ``poses``; node 0 stays where it is.

    The last ``fresh`` edges are new: the poses do not yet know of them, so they are believed at first however
    badly they are met, and less and less so (graduated non-convexity, H. Yang et al., RA-L 2020). Those that
    are not met in the end may have pulled others apart for nothing: all begins anew, without believing in
    them at first. Ends when no pose moves more than ``tolerance`` (metres, radians) in a step.
    """
    if len(edges) == 0:
        return poses.copy()
    is_fresh = np.arange(len(edges)) >= len(edges) - fresh
    while True:
        found = _descend_believing(poses, edges, is_fresh, tolerance)
        is_unmet = is_fresh & (chi_squares(found, edges) > _FADED_CHI_SQUARE)
        if not is_unmet.any():
            return np.column_stack((found[:, :2], wrap(found[:, 2])))
        is_fresh &= ~is_unmet


def _descend_believing(poses: np.ndarray, edges: Edges, is_fresh: np.ndarray, tolerance: float) -> np.ndarray:
    """Descends to where the edges agree best; those that are ``is_fresh`` (E,) are believed at first."""
    free = np.full(len(edges), _FREE_CHI_SQUARE)
    relaxed = chi_squares(poses, edges)[is_fresh].max(initial=_FREE_CHI_SQUARE)
    while relaxed > _FREE_CHI_SQUARE:
        free[is_fresh] = relaxed
        poses = _descend(poses, edges, free, 10.0 * tolerance)
        relaxed *= _RELAXATION
    free[is_fresh] = _FREE_CHI_SQUARE
    return _descend(poses, edges, free, tolerance)


def _descend(poses: np.ndarray, edges: Edges, free: np.ndarray, tolerance: float) -> np.ndarray:
    """Levenberg-Marquardt; ``free`` (E,): chi-square at which each loop edge's influence starts to fade."""
    damping, cost = 0.0, _cost(poses, edges, free)
    for _ in range(_MAX_STEPS):
        step = _step(poses, edges, free, damping)
        moved = poses + step
        moved_cost = _cost(moved, edges, free)
        if moved_cost <= cost:
            poses, cost, damping = moved, moved_cost, 0.1 * damping
        else:
            damping = max(10.0 * damping, 1e-4)
        if np.abs(step).max() < tolerance:
            break
    return poses


def chi_squares(poses: np.ndarray, edges: Edges) -> np.ndarray:
    """How badly each edge is met: its squared error weighted by its information, (E,)."""
    return _chi_squares(poses, edges.nodes, edges.measured, edges.information)


def _room(array: np.ndarray, rows: int) -> np.ndarray:
    larger = np.empty((rows, *array.shape[1:]), dtype=array.dtype)
    larger[: len(array)] = array
    return larger


def _cost(poses: np.ndarray, edges: Edges, free: np.ndarray) -> float:
    chi = chi_squares(poses, edges)
    faded = free * (3.0 * chi - free) / (chi + free)
    return math.fsum(np.where(edges.is_loop & (chi > free), faded, chi))


def _step(poses: np.ndarray, edges: Edges, free: np.ndarray, damping: float) -> np.ndarray:
    """One Gauss-Newton step (N, 3) with loop edges weighed by how well they are met."""
    matrix, gradient = normal_equations(poses, edges, free)
    matrix = matrix[3:, 3:]  # before it is solved, so that the whole one takes no memory then
    step = factors_of(matrix, damping).solve(gradient[3:])
    return np.vstack((np.zeros((1, 3)), -step.reshape(-1, 3)))


def normal_equations(
    poses: np.ndarray, edges: Edges, free: Optional[np.ndarray] = None
) -> Tuple[csc_matrix, np.ndarray]:
    """The information matrix (3 N, 3 N) of all poses, and the gradient (3 N,).

    ``free`` (E,): chi-square at which each loop edge's influence starts to fade; default: as in the end.
    """
    free = np.full(len(edges), _FREE_CHI_SQUARE) if free is None else free
    rows, cols, values, gradient = _linearize(
        poses, edges.nodes, edges.measured, edges.information, edges.is_loop, free
    )
    return coo_matrix((values, (rows, cols)), shape=(3 * len(poses), 3 * len(poses))).tocsc(), gradient


def factors_of(matrix: csc_matrix, damping: float = 0.0) -> SuperLU:
    """Those of an information matrix, which is changed, without the rows and columns of one node."""
    matrix.setdiag(matrix.diagonal() * (1.0 + damping) + 1e-9)
    return splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        panel_size=1,  # larger ones take more memory and, with so few entries in a column, more time
        options={"SymmetricMode": True},
    )


@numba.njit(cache=True, nogil=True)
def _error(poses, first, second, measured):
    """Error (3,) of an edge, and first's heading as cosine and sine with the way to second, (4,)."""
    c, s = math.cos(poses[first, 2]), math.sin(poses[first, 2])
    dx, dy = poses[second, 0] - poses[first, 0], poses[second, 1] - poses[first, 1]
    turn = poses[second, 2] - poses[first, 2] - measured[2]
    turn = (turn + math.pi) % (2.0 * math.pi) - math.pi
    return (c * dx + s * dy - measured[0], c * dy - s * dx - measured[1], turn), (c, s, dx, dy)


@numba.njit(cache=True, nogil=True)
def _chi_square(error, information):
    total = 0.0
    for i in range(3):
        for j in range(3):
            total += error[i] * information[i, j] * error[j]
    return total


@numba.njit(cache=True, nogil=True)
def _chi_squares(poses, nodes, measured, information):
    chi = np.empty(len(nodes))
    for e in range(len(nodes)):
        error, _ = _error(poses, nodes[e, 0], nodes[e, 1], measured[e])
        chi[e] = _chi_square(error, information[e])
    return chi


@numba.njit(cache=True, nogil=True)
def _linearize(poses, nodes, measured, information, is_loop, free):
    """The normal equations: rows, columns and values (36 E,) of the matrix, and the gradient (3 N,)."""
    rows, cols = np.empty(36 * len(nodes), dtype=np.int32), np.empty(36 * len(nodes), dtype=np.int32)
    values, gradient = np.empty(36 * len(nodes)), np.zeros(3 * len(poses))
    at = 0
    jacobian, weighted = np.zeros((3, 6)), np.empty((3, 6))
    for e in range(len(nodes)):
        error, (c, s, dx, dy) = _error(poses, nodes[e, 0], nodes[e, 1], measured[e])
        scale = 1.0
        if is_loop[e]:
            chi = _chi_square(error, information[e])
            scale = min(1.0, 2.0 * free[e] / (free[e] + chi)) ** 2
        jacobian[0, 0], jacobian[0, 1], jacobian[0, 2] = -c, -s, -s * dx + c * dy
        jacobian[1, 0], jacobian[1, 1], jacobian[1, 2] = s, -c, -c * dx - s * dy
        jacobian[0, 3], jacobian[0, 4], jacobian[1, 3], jacobian[1, 4] = c, s, -s, c
        jacobian[2, 2], jacobian[2, 5] = -1.0, 1.0
        for i in range(3):
            for b in range(6):
                weighted[i, b] = 0.0
                for j in range(3):
                    weighted[i, b] += scale * information[e, i, j] * jacobian[j, b]
        for a in range(6):
            row = 3 * nodes[e, a // 3] + a % 3
            for i in range(3):
                gradient[row] += weighted[i, a] * error[i]
            for b in range(6):
                rows[at], cols[at], values[at] = row, 3 * nodes[e, b // 3] + b % 3, 0.0
                for i in range(3):
                    values[at] += jacobian[i, a] * weighted[i, b]
                at += 1
    return rows, cols, values, gradient
