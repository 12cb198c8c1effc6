"""Sparse pose graph optimization with robust loop edges.

G. Grisetti et al., "A tutorial on graph-based SLAM", IEEE ITS Magazine 2010 (Gauss-Newton on the sparse
normal equations); P. Agarwal et al., "Robust map optimization using dynamic covariance scaling", ICRA 2013.
"""

import math
from dataclasses import dataclass
from typing import Optional, Sequence, Tuple

import numba
import numpy as np
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import SuperLU, splu

from planar import Pose2, wrap

_MAX_STEPS = 20
# Phi of dynamic covariance scaling: the chi-square of a loop edge from which on it is down-weighted.
_PHI = 10.0
# Chi-square from which on a loop edge is an outlier, with next to no weight.
_OUTLIER_CHI_SQUARE = 100.0
# Factor by which phi of new edges is reduced at a time.
_RELAXATION = 0.1
# Tolerances of an optimization, metres and radians: while mapping, and at the end.
COARSE, FINE = 5e-3, 1e-5


@dataclass(frozen=True, eq=False)
class Edge:
    """Measurement of one node's pose in the frame of another.

    Attributes:
        first: Index of the node in whose frame the measurement is given.
        second: Index of the measured node.
        second_in_first: Measured pose.
        information: (3, 3), of x, y, yaw along the axes of ``first``, 1 / (m, m, rad)^2.
        is_loop: Whether it is a loop closure, which may be wrong and is weighted robustly.
    """

    first: int
    second: int
    second_in_first: Pose2
    information: np.ndarray
    is_loop: bool = False


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges as arrays.

    Attributes:
        nodes: (E, 2), indices of first and second node.
        measured: (E, 3), pose of second in first, rows ``[x, y, yaw]``.
        information: (E, 3, 3), of ``measured``, 1 / (m, m, rad)^2.
        is_loop: (E,), whether each edge is a loop closure.
    """

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
    """Append-only list of edges, stored as arrays; earlier views stay valid."""

    def __init__(self, edges: Optional[Edges] = None) -> None:
        """Create a list.

        Args:
            edges: Initial edges; by default none.
        """
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
        """Append one edge."""
        i, arrays = self._count, self._arrays
        if i == len(arrays):
            self._arrays = arrays = Edges(*(_enlarged(array, 2 * i + 64) for array in vars(arrays).values()))
        arrays.nodes[i] = edge.first, edge.second
        arrays.measured[i] = edge.second_in_first.as_array()
        arrays.information[i] = edge.information
        arrays.is_loop[i] = edge.is_loop
        self._count += 1

    def view(self) -> Edges:
        """Return the edges so far."""
        return Edges(*(array[: self._count] for array in vars(self._arrays).values()))


def relative_pose(poses: np.ndarray, first: int, second: int) -> Pose2:
    """Compute the pose of one node in the frame of another.

    Args:
        poses: (N, 3), poses of all nodes in a common frame.
        first: Index of the node whose frame is used.
        second: Index of the other node.
    """
    return Pose2.from_array(poses[first]).inverse() @ Pose2.from_array(poses[second])


def edges_of(*edges: Edge) -> Edges:
    """Convert edges to arrays."""
    table = EdgeList()
    for edge in edges:
        table.append(edge)
    return table.view()


def concatenate(edges: Edges, more: Sequence[Edge]) -> Edges:
    """Append edges to arrays of edges; returns new arrays.

    Args:
        edges: Edges as arrays.
        more: Edges to append.
    """
    pairs = zip(vars(edges).values(), vars(edges_of(*more)).values())
    return Edges(*(np.concatenate(pair) for pair in pairs))


def inflate(edge: Edge, sigma_xy: float, sigma_yaw: float) -> Edge:
    """Add an independent error to an edge.

    Args:
        edge: Edge, possibly without information in some direction.
        sigma_xy: Standard deviation of the error in x and in y [m].
        sigma_yaw: Standard deviation of the error in heading [rad].

    Returns:
        The same edge with less information.
    """
    added = np.diag([sigma_xy**-2, sigma_xy**-2, sigma_yaw**-2])
    # Woodbury's identity, as a degenerate match has no covariance to add to.
    information = edge.information
    information = information - information @ np.linalg.solve(added + information, information)
    return Edge(edge.first, edge.second, edge.second_in_first, information, edge.is_loop)


def deflate(edges: Edges, variances: np.ndarray) -> Edges:
    """Remove an independent error from edges, the reverse of ``inflate``.

    Args:
        edges: Edges of the graph, E.
        variances: (E, 3), of the error in x, y and yaw [m^2, m^2, rad^2], smaller than those of the edges.

    Returns:
        The same edges with more information.
    """
    information = edges.information
    # The inverse of a difference of covariances, also of a degenerate match, which has no covariance.
    information = np.linalg.solve(np.eye(3) - information * variances[:, None], information)
    return Edges(edges.nodes, edges.measured, information, edges.is_loop)


def optimize(poses: np.ndarray, edges: Edges, tolerance: float, new_count: int = 0) -> np.ndarray:
    """Find the poses that fit the edges best; node 0 stays fixed.

    New edges do not fit the poses yet, so they start with full weight whatever their error, which then
    decreases (graduated non-convexity, H. Yang et al., RA-L 2020). New edges that are outliers at the end may
    have pulled others apart: the optimization then starts again without full weight for them.

    Args:
        poses: (N, 3), initial poses in the map frame.
        edges: Edges of the graph; new ones last.
        tolerance: Largest change of a pose in the last step, metres and radians.
        new_count: Number of new edges.

    Returns:
        (N, 3), the optimized poses.
    """
    if len(edges) == 0:
        return poses.copy()
    is_new = np.arange(len(edges)) >= len(edges) - new_count
    while True:
        found = _descend_relaxed(poses, edges, is_new, tolerance)
        is_outlier = is_new & (chi_squares(found, edges) > _OUTLIER_CHI_SQUARE)
        if not is_outlier.any():
            return np.column_stack((found[:, :2], wrap(found[:, 2])))
        is_new &= ~is_outlier


def _descend_relaxed(poses: np.ndarray, edges: Edges, is_new: np.ndarray, tolerance: float) -> np.ndarray:
    """Descend to the minimum; edges that are ``is_new`` (E,) get full weight at first."""
    phi = np.full(len(edges), _PHI)
    relaxed = chi_squares(poses, edges)[is_new].max(initial=_PHI)
    while relaxed > _PHI:
        phi[is_new] = relaxed
        poses = _descend(poses, edges, phi, 10.0 * tolerance)
        relaxed *= _RELAXATION
    phi[is_new] = _PHI
    return _descend(poses, edges, phi, tolerance)


def _descend(poses: np.ndarray, edges: Edges, phi: np.ndarray, tolerance: float) -> np.ndarray:
    """Levenberg-Marquardt; ``phi`` (E,) of each loop edge."""
    damping, cost = 0.0, _cost(poses, edges, phi)
    for _ in range(_MAX_STEPS):
        step = _step(poses, edges, phi, damping)
        moved = poses + step
        moved_cost = _cost(moved, edges, phi)
        if moved_cost <= cost:
            poses, cost, damping = moved, moved_cost, 0.1 * damping
        else:
            damping = max(10.0 * damping, 1e-4)
        if np.abs(step).max() < tolerance:
            break
    return poses


def chi_squares(poses: np.ndarray, edges: Edges) -> np.ndarray:
    """Compute the squared error of each edge, weighted by its information.

    Args:
        poses: (N, 3), poses of the nodes in the map frame.
        edges: Edges of the graph, E.

    Returns:
        (E,).
    """
    return _chi_squares(poses, edges.nodes, edges.measured, edges.information)


def _enlarged(array: np.ndarray, rows: int) -> np.ndarray:
    larger = np.empty((rows, *array.shape[1:]), dtype=array.dtype)
    larger[: len(array)] = array
    return larger


def _cost(poses: np.ndarray, edges: Edges, phi: np.ndarray) -> float:
    chi = chi_squares(poses, edges)
    faded = phi * (3.0 * chi - phi) / (chi + phi)
    return math.fsum(np.where(edges.is_loop & (chi > phi), faded, chi))


def _step(poses: np.ndarray, edges: Edges, phi: np.ndarray, damping: float) -> np.ndarray:
    """One Gauss-Newton step (N, 3) with robustly weighted loop edges."""
    matrix, gradient = normal_equations(poses, edges, phi)
    matrix = matrix[3:, 3:]  # a new name would keep the whole one in memory while it is solved
    step = factorize(matrix, damping).solve(gradient[3:])
    return np.vstack((np.zeros((1, 3)), -step.reshape(-1, 3)))


def normal_equations(
    poses: np.ndarray, edges: Edges, phi: Optional[np.ndarray] = None
) -> Tuple[csc_matrix, np.ndarray]:
    """Build the normal equations of a Gauss-Newton step.

    Args:
        poses: (N, 3), poses of the nodes in the map frame.
        edges: Edges of the graph, E.
        phi: (E,), chi-square above which each loop edge is down-weighted; by default the value at the end of
            an optimization.

    Returns:
        Information matrix (3 N, 3 N) of all poses, and gradient (3 N,).
    """
    phi = np.full(len(edges), _PHI) if phi is None else phi
    rows, cols, values, gradient = _linearize(
        poses, edges.nodes, edges.measured, edges.information, edges.is_loop, phi
    )
    return coo_matrix((values, (rows, cols)), shape=(3 * len(poses), 3 * len(poses))).tocsc(), gradient


def factorize(matrix: csc_matrix, damping: float = 0.0) -> SuperLU:
    """Factorize an information matrix.

    Args:
        matrix: Information matrix without the rows and columns of the fixed node; its diagonal is modified.
        damping: Share by which the diagonal is increased (Levenberg-Marquardt).
    """
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
    """Error (3,) of an edge; cosine and sine of first's heading and the offset to second, (4,)."""
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
def _linearize(poses, nodes, measured, information, is_loop, phi):
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
            scale = min(1.0, 2.0 * phi[e] / (phi[e] + chi)) ** 2
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
