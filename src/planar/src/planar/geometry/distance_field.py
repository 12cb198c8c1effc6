"""Exact Euclidean distance transform of obstacle grids, used by likelihood fields and inflation.

Two passes (Meijster, Roerdink and Hesselink, "A general algorithm for computing distance transforms in linear
time", 2000).
"""

import math

import numba
import numpy as np


def distance_field(obstacles: np.ndarray, resolution: float, max_distance: float = np.inf) -> np.ndarray:
    """Compute the distance from each cell centre to the centre of the nearest obstacle cell.

    Args:
        obstacles: Occupied cells, bool (rows, cols).
        resolution: Cell size [m].
        max_distance: Upper limit of the result [m]; also the result where there is no obstacle at all.

    Returns:
        Distances [m], float32 (rows, cols).
    """
    if not obstacles.any():
        return np.full(obstacles.shape, max_distance, dtype=np.float32)
    squares = _squares_along_rows(_cells_along_columns(obstacles))
    return _metres(squares, float(resolution), float(max_distance))


@numba.njit(cache=True)
def _cells_along_columns(obstacles):
    """Return cells, int32, to an obstacle in the same column; rows + cols where there is none."""
    rows, cols = obstacles.shape
    near = np.empty((rows, cols), dtype=np.int32)
    distances = np.full(cols, rows + cols, dtype=np.int32)
    for row in range(rows):
        for col in range(cols):
            distances[col] = 0 if obstacles[row, col] else min(distances[col] + 1, rows + cols)
            near[row, col] = distances[col]
    for row in range(rows - 2, -1, -1):
        for col in range(cols):
            near[row, col] = min(near[row, col], near[row + 1, col] + 1)
    return near


@numba.njit(cache=True)
def _squares_along_rows(near):
    """Return squared distances in cells, int64 (rows, cols); ``near``: cells to an obstacle in the column."""
    rows, cols = near.shape
    squares = np.empty((rows, cols), dtype=np.int64)
    # Columns whose obstacle is nearest to some cell of the row, and the first such cell of each.
    sources, firsts, own = np.empty(cols, np.int64), np.empty(cols, np.int64), np.empty(cols, np.int64)
    for row in range(rows):
        for col in range(cols):
            own[col] = np.int64(near[row, col]) ** 2
        last = sources[0] = firsts[0] = 0
        for col in range(1, cols):
            while last >= 0 and _square(own, firsts[last], sources[last]) > _square(own, firsts[last], col):
                last -= 1
            if last < 0:
                last, sources[0] = 0, col
                continue
            source = sources[last]
            rise = col * col - source * source + own[col] - own[source]
            first = 1 + rise // (2 * (col - source))
            if first < cols:
                last += 1
                sources[last], firsts[last] = col, first
        for col in range(cols - 1, -1, -1):
            squares[row, col] = _square(own, col, sources[last])
            if col == firsts[last]:
                last -= 1
    return squares


@numba.njit(cache=True)
def _square(own, col, source):
    return (col - source) ** 2 + own[source]


@numba.njit(cache=True)
def _metres(squares, resolution, max_distance):
    """Return distances in metres, float32 (rows, cols), at most ``max_distance``, from squares in cells."""
    metres = np.empty(squares.shape, dtype=np.float32)
    for row in range(squares.shape[0]):
        for col in range(squares.shape[1]):
            metres[row, col] = min(math.sqrt(squares[row, col]) * resolution, max_distance)
    return metres
