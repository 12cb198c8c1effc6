"""Graph of free grid cells for the lengths of shortest paths."""

import math
from typing import Any

import numpy as np

# Steps to half of a cell's neighbours on three rings; the other half is symmetric. Paths of these steps are
# at most 1.4 % longer than straight lines.
STEPS = ((0, 1), (1, 0), (1, 1), (1, -1), (1, 2), (2, 1), (1, -2), (2, -1), (1, 3), (3, 1), (1, -3), (3, -1))


def grid_graph(is_open: np.ndarray, resolution: float) -> Any:
    """Make the graph of steps between free cells.

    Args:
        is_open: Free cells, bool (rows, cols).
        resolution: Cell size [m].

    Returns:
        Undirected graph of step lengths [m], a scipy csr matrix; cell (row, col) is node ``row * cols +
        col``.
    """
    from scipy.sparse import coo_matrix  # imported late: few users need it

    numbers = np.arange(is_open.size).reshape(is_open.shape)
    rows, cols = is_open.shape
    starts, ends, lengths = [], [], []
    for down, right in STEPS:
        here = (slice(0, rows - down), slice(max(0, -right), cols - max(0, right)))
        there = (slice(down, rows), slice(max(0, right), cols + min(0, right)))
        both = is_open[here] & is_open[there]
        starts.append(numbers[here][both])
        ends.append(numbers[there][both])
        lengths.append(np.full(int(both.sum()), resolution * math.hypot(down, right)))
    pairs = (np.concatenate(starts), np.concatenate(ends))
    return coo_matrix((np.concatenate(lengths), pairs), shape=(is_open.size, is_open.size)).tocsr()
