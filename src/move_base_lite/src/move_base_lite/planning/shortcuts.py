"""Any-angle smoothing: straight lines where they cost no more than the path between their ends."""

import math

import numba
import numpy as np

from move_base_lite.planning.wavefront import IMPASSABLE

# Spacing of the smoothed path [cells].
SPACING = 0.5
# Distance on both sides of a line that must be free [cells].
SIDE_MARGIN = 0.05


@numba.njit(cache=True)
def shorten(traversal, path, longest):
    """Replace parts of a path by straight shortcuts; the result is never longer nor more expensive.

    Args:
        traversal: (rows, cols) cost of entering each cell, uint8.
        path: (N, 2) of col, row.
        longest: Maximum length of a shortcut [cells].

    Returns:
        Path (M, 2) of col, row with the same ends; points at most half a cell apart.
    """
    costs = np.zeros(path.shape[0])
    for i in range(1, path.shape[0]):
        length = math.hypot(path[i, 0] - path[i - 1, 0], path[i, 1] - path[i - 1, 1])
        costs[i] = costs[i - 1] + length * traversal[int(path[i, 1]), int(path[i, 0])]
    kept = [0]
    while kept[-1] < path.shape[0] - 1:
        here = kept[-1]
        reached, stride = here + 1, 1
        # Double the stride after a success, halve it after a failure.
        while stride > 0:
            there = min(reached + stride, path.shape[0] - 1)
            if there > reached and _is_cheaper(traversal, path, costs, here, there, longest):
                reached = there
                stride *= 2
            else:
                stride //= 2
        kept.append(reached)
    return _interpolate(path, kept)


@numba.njit(cache=True)
def _is_cheaper(traversal, path, costs, here, there, longest):
    length = math.hypot(path[there, 0] - path[here, 0], path[there, 1] - path[here, 1])
    return length <= longest and _line_cost(traversal, path[here], path[there]) <= costs[there] - costs[here]


@numba.njit(cache=True)
def _line_cost(traversal, start, end):
    """Cost of a straight line between two points, inf if a cell within SIDE_MARGIN is impassable."""
    along_x, along_y = end[0] - start[0], end[1] - start[1]
    length = math.hypot(along_x, along_y)
    if length == 0.0:
        return 0.0
    aside_x, aside_y = -SIDE_MARGIN * along_y / length, SIDE_MARGIN * along_x / length
    pieces = 2 * max(1, int(math.ceil(length / SPACING)))
    total = 0.0
    for i in range(1, pieces + 1):
        x, y = start[0] + i / pieces * along_x, start[1] + i / pieces * along_y
        left = traversal[int(math.floor(y + aside_y)), int(math.floor(x + aside_x))]
        right = traversal[int(math.floor(y - aside_y)), int(math.floor(x - aside_x))]
        if max(left, right) >= IMPASSABLE:
            return np.inf
        total += 0.5 * (left + right)
    return total / pieces * length


@numba.njit(cache=True)
def _interpolate(path, kept):
    """Points along the shortcuts; single steps of the path stay as they are."""
    pieces = np.ones(len(kept), dtype=np.int64)
    for i in range(1, len(kept)):
        if kept[i] > kept[i - 1] + 1:
            a, b = path[kept[i - 1]], path[kept[i]]
            pieces[i] = max(1, int(math.ceil(math.hypot(b[0] - a[0], b[1] - a[1]) / SPACING)))
    filled = np.empty((pieces.sum(), 2))
    filled[0] = path[0]
    at = 1
    for i in range(1, len(kept)):
        a, b = path[kept[i - 1]], path[kept[i]]
        for piece in range(1, pieces[i] + 1):
            filled[at] = a + piece / pieces[i] * (b - a)
            at += 1
    return filled
