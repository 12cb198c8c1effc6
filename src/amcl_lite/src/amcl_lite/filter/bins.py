"""The histogram of a particle set: bins of 0.5 m x 0.5 m x 10 degrees, stored in a hash table.

KLD-sampling counts the bins that hold particles; bins that touch make up a cluster.
"""

import math

import numba
import numpy as np

BIN_METRES = 0.5
BINS_PER_TURN = 36

_EMPTY = np.int64(-1)
_OFFSET = np.int64(1 << 23)


@numba.njit(cache=True)
def new_table(capacity):
    """A hash table with room for ``capacity`` bins."""
    size = 16
    while size < 2 * capacity:
        size *= 2
    return np.full(size, _EMPTY)


@numba.njit(cache=True)
def bin_of(x, y, yaw):
    """The bin (three integers) in which a pose lies; the third counts round the circle."""
    turn = int(math.floor(yaw / (2.0 * math.pi) * BINS_PER_TURN)) % BINS_PER_TURN
    return int(math.floor(x / BIN_METRES)), int(math.floor(y / BIN_METRES)), turn


@numba.njit(cache=True)
def slot_of(table, col, row, turn):
    """Where a bin is in the table, or the empty slot where it belongs."""
    key = _key(col, row, turn)
    mask = table.size - 1
    slot = (key * np.int64(0x9E3779B97F4A7C1)) >> np.int64(20) & mask
    while table[slot] != _EMPTY and table[slot] != key:
        slot = (slot + 1) & mask
    return slot


@numba.njit(cache=True)
def insert(table, col, row, turn):
    """Puts a bin into the table; returns whether it is new."""
    slot = slot_of(table, col, row, turn)
    is_new = table[slot] == _EMPTY
    table[slot] = _key(col, row, turn)
    return is_new


@numba.njit(cache=True)
def _key(col, row, turn):
    return ((col + _OFFSET) << np.int64(32)) | ((row + _OFFSET) << np.int64(8)) | np.int64(turn)


def cluster_labels(poses: np.ndarray) -> np.ndarray:
    """Numbers (N,), from 0, of the clusters of particles (N, 3); bins that touch are of one cluster."""
    return _cluster_labels(poses)


@numba.njit(cache=True)
def _cluster_labels(poses):
    count = poses.shape[0]
    table = new_table(count)
    labels_of_slots = np.full(table.size, -1)
    bins = np.empty((count, 3), dtype=np.int64)
    for i in range(count):
        bins[i] = bin_of(poses[i, 0], poses[i, 1], poses[i, 2])
        insert(table, bins[i, 0], bins[i, 1], bins[i, 2])
    stack = np.empty((table.size, 3), dtype=np.int64)
    labels = np.empty(count, dtype=np.int64)
    clusters = 0
    for i in range(count):
        slot = slot_of(table, bins[i, 0], bins[i, 1], bins[i, 2])
        if labels_of_slots[slot] < 0:
            labels_of_slots[slot] = clusters
            stack[0] = bins[i]
            _spread_label(table, labels_of_slots, stack, clusters)
            clusters += 1
        labels[i] = labels_of_slots[slot]
    return labels


@numba.njit(cache=True)
def _spread_label(table, labels_of_slots, stack, label):
    height = 1
    while height > 0:
        height -= 1
        col, row, turn = stack[height]
        for neighbour in range(27):
            c, r = col + neighbour // 9 - 1, row + neighbour // 3 % 3 - 1
            t = (turn + neighbour % 3 - 1) % BINS_PER_TURN
            slot = slot_of(table, c, r, t)
            if table[slot] != _EMPTY and labels_of_slots[slot] < 0:
                labels_of_slots[slot] = label
                stack[height] = (c, r, t)
                height += 1
