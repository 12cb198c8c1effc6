"""A pose graph of fewer nodes: what is left is tied as firmly as it was."""

from typing import Dict, Tuple

import numpy as np

from slam_lite.graph.drift import drift_along, shortest_ways, variances_xy
from slam_lite.graph.pose_graph import Edge, EdgeList, Edges, between

# A loop's end may be moved so far to a node that is kept, metres.
_NEAR = 1.0
# No tie is firmer than this, metres and radians.
_LEAST_XY, _LEAST_YAW = 0.01, 0.003


def condensed(poses: np.ndarray, edges: Edges, kept: np.ndarray) -> Edges:
    """The edges of a settled graph, ``poses`` (N, 3), for its nodes ``kept`` alone, numbered anew.

    Neighbours that were no neighbours before are tied as far apart as they are now, and as surely as the
    graph knew that. Loops end at the nearest nodes that are kept, or are left out where those are far.
    """
    number = {int(key): i for i, key in enumerate(kept)}
    table = EdgeList()
    steps = {tuple(pair): i for i, pair in enumerate(edges.nodes.tolist()) if not edges.is_loop[i]}
    for first, second in zip(kept[:-1], kept[1:]):
        known = steps.get((int(first), int(second)))
        edge = edges[known] if known is not None else _tie(int(first), int(second), poses, edges)
        table.append(_renumbered(edge, number))
    for edge in _moved_loops(poses, edges, kept).values():
        table.append(_renumbered(edge, number))
    return table.view()


def _tie(first: int, second: int, poses: np.ndarray, edges: Edges) -> Edge:
    ways, before = shortest_ways(first, len(poses), edges, np.sqrt(variances_xy(edges)))
    xy, yaw = (drift[second] for drift in drift_along(ways, before, poses, edges))
    xy, yaw = max(float(xy), _LEAST_XY), max(float(yaw), _LEAST_YAW)
    return Edge(first, second, between(poses, first, second), np.diag([xy**-2, xy**-2, yaw**-2]))


def _moved_loops(poses: np.ndarray, edges: Edges, kept: np.ndarray) -> Dict[Tuple[int, int], Edge]:
    """The loops between the kept nodes nearest to their ends, the surest of each pair."""
    nearest = kept[_nearest(poses, kept)]
    is_near = np.hypot(*(poses[:, :2] - poses[nearest, :2]).T) < _NEAR
    loops: Dict[Tuple[int, int], Edge] = {}
    for i in np.flatnonzero(edges.is_loop & is_near[edges.nodes].all(axis=1)):
        loop = edges[i]
        first, second = int(nearest[loop.first]), int(nearest[loop.second])
        if abs(first - second) < 2:
            continue
        first_in_new = between(poses, first, loop.first)
        measured = first_in_new @ loop.second_in_first @ between(poses, loop.second, second)
        c, s = np.cos(first_in_new.yaw), np.sin(first_in_new.yaw)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        moved = Edge(first, second, measured, turn @ loop.information @ turn.T, is_loop=True)
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
