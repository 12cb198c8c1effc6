"""Sparsification of a pose graph: remove nodes and keep the information between the others."""

from typing import Dict, Tuple

import numpy as np

from slam_lite.graph.drift import drift_along, shortest_paths, variances_xy
from slam_lite.graph.pose_graph import Edge, EdgeList, Edges, relative_pose

# Distance by which the end of a loop edge may be moved to a remaining node [m].
_NEAR = 1.0
# Least standard deviations of a new edge, metres and radians.
_LEAST_XY, _LEAST_YAW = 0.01, 0.003


def sparsify(poses: np.ndarray, edges: Edges, kept: np.ndarray) -> Edges:
    """Remove nodes from an optimized graph.

    Remaining nodes that become neighbours are connected by edges with their present relative pose and its
    covariance in the graph. Loop edges move to the nearest remaining nodes; they are removed if those are
    far.

    Args:
        poses: (N, 3), poses of the nodes in the map frame.
        edges: Edges of the graph.
        kept: Indices of the remaining nodes, ascending.

    Returns:
        Edges between the remaining nodes, renumbered from 0.
    """
    number = {int(node): i for i, node in enumerate(kept)}
    table = EdgeList()
    steps = {tuple(pair): i for i, pair in enumerate(edges.nodes.tolist()) if not edges.is_loop[i]}
    for first, second in zip(kept[:-1], kept[1:]):
        known = steps.get((int(first), int(second)))
        edge = edges[known] if known is not None else _new_edge(int(first), int(second), poses, edges)
        table.append(_renumbered(edge, number))
    for edge in _moved_loops(poses, edges, kept).values():
        table.append(_renumbered(edge, number))
    return table.view()


def _new_edge(first: int, second: int, poses: np.ndarray, edges: Edges) -> Edge:
    paths, before = shortest_paths(first, len(poses), edges, np.sqrt(variances_xy(edges)))
    xy, yaw = (drift[second] for drift in drift_along(paths, before, poses, edges))
    xy, yaw = max(float(xy), _LEAST_XY), max(float(yaw), _LEAST_YAW)
    return Edge(first, second, relative_pose(poses, first, second), np.diag([xy**-2, xy**-2, yaw**-2]))


def _moved_loops(poses: np.ndarray, edges: Edges, kept: np.ndarray) -> Dict[Tuple[int, int], Edge]:
    """Loop edges between the remaining nodes nearest to their ends, the most certain one of each pair."""
    nearest = kept[_nearest(poses, kept)]
    is_near = np.hypot(*(poses[:, :2] - poses[nearest, :2]).T) < _NEAR
    loops: Dict[Tuple[int, int], Edge] = {}
    for i in np.flatnonzero(edges.is_loop & is_near[edges.nodes].all(axis=1)):
        loop = edges[i]
        first, second = int(nearest[loop.first]), int(nearest[loop.second])
        if abs(first - second) < 2:
            continue
        first_in_new = relative_pose(poses, first, loop.first)
        measured = first_in_new @ loop.second_in_first @ relative_pose(poses, loop.second, second)
        c, s = np.cos(first_in_new.yaw), np.sin(first_in_new.yaw)
        rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        moved = Edge(first, second, measured, rotation @ loop.information @ rotation.T, is_loop=True)
        other = loops.get((first, second))
        if other is None or np.trace(other.information) < np.trace(moved.information):
            loops[first, second] = moved
    return loops


def _nearest(poses: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """For each of ``poses`` (N, 3) the index in ``kept`` of the nearest one by number, (N,)."""
    numbers = np.arange(len(poses))
    after = np.clip(np.searchsorted(kept, numbers), 0, len(kept) - 1)
    before = np.maximum(after - 1, 0)
    return np.where(np.abs(kept[after] - numbers) <= np.abs(numbers - kept[before]), after, before)


def _renumbered(edge: Edge, number: Dict[int, int]) -> Edge:
    first, second = number[edge.first], number[edge.second]
    return Edge(first, second, edge.second_in_first, edge.information, edge.is_loop)
