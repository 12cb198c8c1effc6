"""The wavefront of navfn: cost from one cell to all others (Konolige, "A gradient method", 2000)."""

import math
from typing import Optional

import numba
import numpy as np

NEUTRAL = 50.0
FACTOR = 0.8
LETHAL = 253
IMPASSABLE = 254
# Increment of the threshold, and cost by which the wavefront passes the goal, whose gradient needs it.
THRESHOLD_STEP = 2.0 * NEUTRAL
SETTLED_BEYOND = 2.0 * NEUTRAL
# A*'s heuristic per cell: slightly less than the least possible cost, as the gradient is smooth only where
# the wavefront has spread beyond the straight line.
HEURISTIC = 0.9 * NEUTRAL


@numba.njit(cache=True)
def traversal_costs(costs, allow_unknown, neutral, factor, lethal):
    """Compute the cost of entering each cell, as in navfn; by default 50 + 0.8 cost, at most 253.

    The border of the map is impassable, so that every neighbour of a passable cell is inside.

    Args:
        costs: uint8 (rows, cols).
        allow_unknown: Whether unknown cells are passable.
        neutral: Cost of entering a free cell.
        factor: Factor of a cell's cost that is added.
        lethal: Cost from which on a cell is impassable.

    Returns:
        uint8 (rows, cols); 254 is impassable.
    """
    rows, cols = costs.shape
    by_cost = np.full(256, IMPASSABLE, dtype=np.uint8)
    for cost in range(lethal):
        by_cost[cost] = min(int(neutral + factor * cost), lethal)
    if allow_unknown:
        by_cost[255] = 253
    traversal = np.full((rows, cols), IMPASSABLE, dtype=np.uint8)
    for row in range(1, rows - 1):
        for col in range(1, cols - 1):
            traversal[row, col] = by_cost[costs[row, col]]
    return traversal


def cost_to_go(costs: np.ndarray, targets: np.ndarray) -> Optional[np.ndarray]:
    """Compute the cost to go to the last passable target.

    Args:
        costs: (rows, cols), uint8.
        targets: (N, 2) of row, col; those outside of the grid are ignored.

    Returns:
        Potential (rows, cols), float32, inf for unreachable cells; None if no target is passable.
    """
    traversal = traversal_costs(costs, True, NEUTRAL, FACTOR, LETHAL)  # numba is slow with default arguments
    inside = ((targets >= 0) & (targets < costs.shape)).all(axis=1)
    targets = targets[inside]
    free = np.flatnonzero(traversal[targets[:, 0], targets[:, 1]] < IMPASSABLE)
    if not len(free):
        return None
    row, col = map(int, targets[free[-1]])
    # The corner is impassable, so the wavefront spreads everywhere.
    return propagate_wavefront(traversal, row, col, 0, 0, False)


@numba.njit(cache=True)
def propagate_wavefront(traversal, start_row, start_col, goal_row, goal_col, use_astar):
    """Propagate the potential from the start until that of the goal is final (navfn: propNavFn*).

    Cells wait in three lists: the current and the next round, and those above the threshold, which rises when
    the others are done.

    Args:
        traversal: (rows, cols) cost of entering each cell, uint8.
        start_row: Row of the start.
        start_col: Column of the start.
        goal_row: Row of the goal.
        goal_col: Column of the goal.
        use_astar: Whether the straight distance to the goal is added to a cell's priority.

    Returns:
        Potential (rows, cols), float32, inf where the wavefront did not arrive.
    """
    cols, flat = traversal.shape[1], traversal.ravel()
    potential = np.full(flat.size, np.inf, dtype=np.float32)
    waiting = np.zeros(flat.size, dtype=np.bool_)
    lists = np.empty((3, flat.size), dtype=np.int32)
    current, following, beyond = lists[0], lists[1], lists[2]
    expected = HEURISTIC if use_astar else 0.0
    start, goal = start_row * cols + start_col, goal_row * cols + goal_col
    potential[start] = 0.0
    threshold = NEUTRAL + expected * math.hypot(goal_row - start_row, goal_col - start_col)
    n_current = _enlist(current, 0, start, potential[start], cols, flat, potential, waiting)
    n_following, n_beyond = 0, 0
    while n_current > 0:
        for i in range(n_current):
            waiting[current[i]] = False
        for i in range(n_current):
            cell = current[i]
            reached = _potential_from_neighbours(potential, cell, cols, float(flat[cell]))
            if reached >= potential[cell]:
                continue
            potential[cell] = reached
            row, col = cell // cols, cell % cols
            away = HEURISTIC * math.hypot(goal_row - row, goal_col - col) if use_astar else 0.0
            if reached + away < threshold:
                n_following = _enlist(following, n_following, cell, reached, cols, flat, potential, waiting)
            else:
                n_beyond = _enlist(beyond, n_beyond, cell, reached, cols, flat, potential, waiting)
        current, following, n_current, n_following = following, current, n_following, 0
        if n_current == 0:
            if potential[goal] + SETTLED_BEYOND < threshold:
                break
            threshold += THRESHOLD_STEP
            current, beyond, n_current, n_beyond = beyond, current, n_beyond, 0
    return potential.reshape(traversal.shape)


# Inlined, as the calls would take a fifth of the time.
@numba.njit(cache=True, inline="always")
def _enlist(cells, count, cell, reached, cols, flat, potential, waiting):
    """Append the neighbours that are reached at lower cost from here; returns the list's length."""
    for step in (1, -1, cols, -cols):
        other = cell + step
        if waiting[other] or flat[other] >= IMPASSABLE:
            continue
        if potential[other] > reached + 0.707 * flat[other]:
            waiting[other] = True
            cells[count] = other
            count += 1
    return count


@numba.njit(cache=True)
def _potential_from_neighbours(potential, cell, cols, cost):
    """Planar wave update from the lower of each pair of opposite neighbours, as navfn approximates it."""
    horizontal = min(potential[cell - 1], potential[cell + 1])
    vertical = min(potential[cell - cols], potential[cell + cols])
    lower, higher = min(horizontal, vertical), max(horizontal, vertical)
    difference = higher - lower
    if difference >= cost:
        return np.float32(lower + cost)
    ratio = difference / cost
    return np.float32(lower + cost * (-0.2301 * ratio * ratio + 0.5307 * ratio + 0.7040))


@numba.njit(cache=True)
def trace_path(potential, start_row, start_col, goal_row, goal_col, step):
    """Trace the path from start to goal down the gradient (navfn: calcPath).

    Args:
        potential: (rows, cols), float32.
        start_row: Row of the start.
        start_col: Column of the start.
        goal_row: Row of the goal.
        goal_col: Column of the goal.
        step: Distance between points [cells]; 0: from cell to neighbouring cell.

    Returns:
        Path (N, 2) of col, row [cells], with centres at .5; empty if the goal was not reached.
    """
    rows, cols = potential.shape
    if not math.isfinite(potential[goal_row, goal_col]):
        return np.empty((0, 2))
    limit = 4 * rows * cols
    points = np.empty((1024, 2))
    row, col = float(goal_row), float(goal_col)
    count = 0
    while count < limit:
        if count + 1 >= points.shape[0]:
            grown = np.empty((2 * points.shape[0], 2))
            grown[:count] = points[:count]
            points = grown
        points[count, 0], points[count, 1] = col + 0.5, row + 0.5
        count += 1
        if math.hypot(row - start_row, col - start_col) < 1.0:
            points[count, 0], points[count, 1] = start_col + 0.5, start_row + 0.5
            return points[: count + 1][::-1].copy()
        nearest_row, nearest_col = int(round(row)), int(round(col))
        smooth = step > 0.0
        if smooth:
            slope_row, slope_col, smooth = _slope(potential, row, col)
        if smooth:
            next_row, next_col = row - step * slope_row, col - step * slope_col
            landing = potential[int(round(next_row)), int(round(next_col))]
            smooth = landing <= potential[nearest_row, nearest_col]
        if not smooth:
            next_row, next_col = _lowest_neighbour(potential, nearest_row, nearest_col)
            if next_row == nearest_row and next_col == nearest_col:
                break
        row, col = next_row, next_col
    return np.empty((0, 2))


@numba.njit(cache=True)
def _slope(potential, row, col):
    """Unit gradient between cell centres, bilinear; False next to unreached cells."""
    rows, cols = potential.shape
    base_row, base_col = int(math.floor(row)), int(math.floor(col))
    if base_row < 1 or base_col < 1 or base_row > rows - 3 or base_col > cols - 3:
        return 0.0, 0.0, False
    along_row, along_col = 0.0, 0.0
    for i in range(2):
        for j in range(2):
            r, c = base_row + i, base_col + j
            weight = (row - base_row if i else 1.0 - row + base_row) * (
                col - base_col if j else 1.0 - col + base_col
            )
            if weight == 0.0:
                continue
            by_row = potential[r + 1, c] - potential[r - 1, c]
            by_col = potential[r, c + 1] - potential[r, c - 1]
            if not (math.isfinite(by_row) and math.isfinite(by_col) and math.isfinite(potential[r, c])):
                return 0.0, 0.0, False
            along_row += weight * by_row
            along_col += weight * by_col
    length = math.hypot(along_row, along_col)
    if length < 1e-6:
        return 0.0, 0.0, False
    return along_row / length, along_col / length, True


@numba.njit(cache=True)
def _lowest_neighbour(potential, row, col):
    rows, cols = potential.shape
    best_row, best_col = row, col
    for r in range(max(row - 1, 0), min(row + 2, rows)):
        for c in range(max(col - 1, 0), min(col + 2, cols)):
            if potential[r, c] < potential[best_row, best_col]:
                best_row, best_col = r, c
    return float(best_row), float(best_col)
