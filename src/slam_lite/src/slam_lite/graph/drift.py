"""Drift of the graph between two of its nodes, from the errors along the shortest path."""

from typing import Tuple

import numba
import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from slam_lite.graph.pose_graph import Edges

# Lower bound of an information [1 / m^2].
_LEAST_INFORMATION = 1e-6
# Steps with possible wheel slip have a large heading variance, so that the graph can bend there, but few of
# them have slipped: their average standard deviation of heading [rad]. Edges with a larger one than the
# second value [rad] are no steps, but guesses of where a new trajectory starts.
_AVERAGE_YAW, _GUESSED_YAW = 0.024, 0.2


def shortest_paths(
    start: int, count: int, edges: Edges, lengths: np.ndarray, limit: float = np.inf
) -> Tuple[np.ndarray, np.ndarray]:
    """Find the shortest paths from one node to all others (Dijkstra).

    Args:
        start: Index of the node.
        count: Number of nodes, N.
        edges: Edges of the graph, E.
        lengths: (E,), length of each edge.
        limit: Longest path to search; nodes farther away get an infinite length.

    Returns:
        Lengths (N,) of the paths, and the predecessor (N,) of each node on its path, negative if there is
        none.
    """
    graph = csr_matrix((lengths, tuple(edges.nodes.T)), shape=(count, count))
    return dijkstra(graph, directed=False, indices=start, return_predecessors=True, limit=limit)


def with_average_slip(edges: Edges) -> Edges:
    """Return the edges with an average heading variance for steps with possible wheel slip.

    Few of these steps have slipped, so the sum of individual variances would overestimate the drift.

    Args:
        edges: Edges of the graph.
    """
    information, yaw = edges.information.copy(), edges.information[:, 2, 2]
    is_loose = ~edges.is_loop & (yaw < _AVERAGE_YAW**-2) & (yaw > _GUESSED_YAW**-2)
    information[is_loose, 2, 2] = _AVERAGE_YAW**-2
    return Edges(edges.nodes, edges.measured, information, edges.is_loop)


def variances_xy(edges: Edges) -> np.ndarray:
    """Compute the largest position variance of each edge over all directions.

    Args:
        edges: Edges of the graph, E.

    Returns:
        (E,) [m^2].
    """
    along_x, along_y, mixed = (edges.information[:, i, j] for i, j in ((0, 0), (1, 1), (0, 1)))
    least = 0.5 * (along_x + along_y) - np.hypot(0.5 * (along_x - along_y), mixed)
    return 1.0 / np.maximum(least, _LEAST_INFORMATION)


def drift_along(
    paths: np.ndarray, before: np.ndarray, poses: np.ndarray, edges: Edges
) -> Tuple[np.ndarray, np.ndarray]:
    """Propagate errors along the shortest paths.

    An error in heading rotates everything after it, so it counts in proportion to the straight distance from
    where it occurs.

    Args:
        paths: (N,), lengths from ``shortest_paths``.
        before: (N,), predecessors from ``shortest_paths``.
        poses: (N, 3), poses of the nodes in the map frame.
        edges: Edges of the graph.

    Returns:
        Standard deviations (N,) of position [m] and of heading [rad], relative to the start of the paths.
    """
    first, second = edges.nodes.T
    xy = variances_xy(edges)
    yaw = 1.0 / edges.information[:, 2, 2]
    # The best edge between each node and its predecessor, if there are several.
    best_xy, best_yaw = np.full(len(poses), np.inf), np.full(len(poses), np.inf)
    for one, other in ((first, second), (second, first)):
        used = before[one] == other
        np.minimum.at(best_xy, one[used], xy[used])
        np.minimum.at(best_yaw, one[used], yaw[used])
    order = np.argsort(paths, kind="stable")[: np.count_nonzero(np.isfinite(paths))]
    variances = np.full((len(poses), 2), np.inf)
    _accumulate(order, before, poses, best_xy, best_yaw, variances)
    return np.sqrt(variances[:, 0]), np.sqrt(variances[:, 1])


@numba.njit(cache=True, nogil=True)
def _accumulate(order, before, poses, xy, yaw, variances):
    """Sum the variances from the start on, that of heading with its moments about the origin."""
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
        xy_sum, turn, tx, ty, squared = sums[node]
        variances[node, 0] = xy_sum + max(0.0, turn * (x * x + y * y) - 2.0 * (tx * x + ty * y) + squared)
        variances[node, 1] = turn
