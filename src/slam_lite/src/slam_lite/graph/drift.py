"""How far the graph may be off between two of its nodes, from the errors along the shortest way."""

from typing import Tuple

import numba
import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from slam_lite.graph.pose_graph import Edges

# Nothing is known less surely than this, 1 / m^2.
_LEAST_INFORMATION = 1e-6
# Steps on which wheels may have slipped unseen are tied loosely, for the graph to bend there; but few have.
# Standard deviation of heading of one on the average, radians; and of what is no step, but a guess of where a
# new trajectory begins, from which on.
_AVERAGE_YAW, _GUESSED_YAW = 0.024, 0.2


def shortest_ways(
    start: int, count: int, edges: Edges, lengths: np.ndarray, limit: float = np.inf
) -> Tuple[np.ndarray, np.ndarray]:
    """Length (N,) of the shortest way from ``start`` to each of ``count`` nodes, and the node before on it.

    ``lengths``: (E,) of the edges. Ways longer than ``limit`` are not followed and count as infinite.
    """
    graph = csr_matrix((lengths, tuple(edges.nodes.T)), shape=(count, count))
    return dijkstra(graph, directed=False, indices=start, return_predecessors=True, limit=limit)


def on_average(edges: Edges) -> Edges:
    """The edges, with loose steps as sure as many of them are together, of which a few have slipped."""
    information, yaw = edges.information.copy(), edges.information[:, 2, 2]
    is_loose = ~edges.is_loop & (yaw < _AVERAGE_YAW**-2) & (yaw > _GUESSED_YAW**-2)
    information[is_loose, 2, 2] = _AVERAGE_YAW**-2
    return Edges(edges.nodes, edges.measured, information, edges.is_loop)


def variances_xy(edges: Edges) -> np.ndarray:
    """Variances (E,) of position in the direction, whichever it is, of which each edge knows least."""
    along_x, along_y, mixed = (edges.information[:, i, j] for i, j in ((0, 0), (1, 1), (0, 1)))
    least = 0.5 * (along_x + along_y) - np.hypot(0.5 * (along_x - along_y), mixed)
    return 1.0 / np.maximum(least, _LEAST_INFORMATION)


def drift_along(
    ways: np.ndarray, before: np.ndarray, poses: np.ndarray, edges: Edges
) -> Tuple[np.ndarray, np.ndarray]:
    """Standard deviations (N,) of position, metres, and heading, radians, as seen from the ways' start.

    ``ways``, ``before``: of ``shortest_ways``; ``poses``: (N, 3). An error in heading swings all that lies
    behind it: it counts as often as the straight way from there is long.
    """
    first, second = edges.nodes.T
    xy = variances_xy(edges)
    yaw = 1.0 / edges.information[:, 2, 2]
    # The best edge between each node and the one before, if several tie them.
    best_xy, best_yaw = np.full(len(poses), np.inf), np.full(len(poses), np.inf)
    for one, other in ((first, second), (second, first)):
        used = before[one] == other
        np.minimum.at(best_xy, one[used], xy[used])
        np.minimum.at(best_yaw, one[used], yaw[used])
    order = np.argsort(ways, kind="stable")[: np.count_nonzero(np.isfinite(ways))]
    variances = np.full((len(poses), 2), np.inf)
    _accumulate(order, before, poses, best_xy, best_yaw, variances)
    return np.sqrt(variances[:, 0]), np.sqrt(variances[:, 1])


@numba.njit(cache=True, nogil=True)
def _accumulate(order, before, poses, xy, yaw, variances):
    """Sums of the variances from the start on, and of heading's with its moments about the origin."""
    sums = np.zeros((len(poses), 5))
    for node in order:
        last = before[node]
        if last >= 0:
            x, y = poses[last, 0], poses[last, 1]
            sums[node] = sums[last]
            sums[node] += np.array(
                (xy[node], yaw[node], yaw[node] * x, yaw[node] * y, yaw[node] * (x * x + y * y))
            )
        x, y = poses[node, 0], poses[node, 1]
        way, turn, tx, ty, squared = sums[node]
        variances[node, 0] = way + max(0.0, turn * (x * x + y * y) - 2.0 * (tx * x + ty * y) + squared)
        variances[node, 1] = turn
