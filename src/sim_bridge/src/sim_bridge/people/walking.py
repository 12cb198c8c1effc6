"""Pedestrians walk to their goals in turn: the choice of goals and the motion."""

import math

import numba
import numpy as np

from sim_bridge.people.forces import forces_on, move

# Distance at which a goal is reached [m], decrease of the remaining path that counts as progress [m], and
# time without progress after which a pedestrian goes to the next goal [s].
GOAL_TOLERANCE, PROGRESS_DISTANCE, PATIENCE = 0.35, 0.3, 4.0


@numba.njit(cache=True)
def walk(
    rows,
    goals,
    progress,
    robots,
    stamps,
    seconds,
    speeds_and_rests,
    groups,
    first_goals,
    goal_counts,
    goals_xy,
    goal_distances,
    walls,
    corner,
    size,
):
    """Let pedestrians walk for some time while robots stand still.

    Args:
        rows: States (N, 5), as ``Crowd.rows``; changed in place.
        goals: Number of each one's goal (N,) among its own; changed in place.
        progress: (N, 3) of the time until which it rests [s], its shortest remaining path so far [m] and the
            time of its last progress [s]; changed in place.
        robots: States (M, 5) of robots.
        stamps: Simulated times (K,) at which they move [s].
        seconds: Time between them [s].
        speeds_and_rests: Preferred speed [m/s] and rest at each goal [s] (N, 2).
        groups: Numbers (N,) of their groups; 0 for none.
        first_goals: Index (N,) of the first goal in ``goals_xy``.
        goal_counts: Number (N,) of goals.
        goals_xy: All goals (G, 2) [m].
        goal_distances: Path length (G, rows, cols) from each cell to each goal [m].
        walls: Distance (rows, cols) of each cell to walls [m].
        corner: Corner of the grid (2,) [m].
        size: Size of a cell [m].

    Returns:
        Positions (K, N, 2) after each [m].
    """
    count = len(rows)
    walked_xy, speeds, targets = np.empty((len(stamps), count, 2)), np.empty(count), np.empty(count, np.int64)
    near, near_robots = rows.copy(), robots.copy()
    near_robots[:, :2] -= corner
    for k in range(len(stamps)):
        for i in range(count):
            goal, x, y = first_goals[i] + goals[i], rows[i, 0], rows[i, 1]
            has_arrived = math.hypot(goals_xy[goal, 0] - x, goals_xy[goal, 1] - y) < GOAL_TOLERANCE
            remaining = _value_of_cell(goal_distances[goal], x - corner[0], y - corner[1], size)
            rest = speeds_and_rests[i, 1]
            if _has_to_leave(progress[i], stamps[k], has_arrived, remaining, rest, goal_counts[i]):
                goals[i] = (goals[i] + 1) % goal_counts[i]
            speeds[i] = 0.0 if stamps[k] < progress[i, 0] else speeds_and_rests[i, 0]
            targets[i] = first_goals[i] + goals[i]
        near[:] = rows
        near[:, :2] -= corner
        forces = forces_on(near, groups, near_robots, walls, size)
        move(near, speeds, targets, forces, walls, goal_distances, size, seconds)
        rows[:] = near
        rows[:, :2] += corner
        walked_xy[k] = rows[:, :2]
    return walked_xy


@numba.njit(cache=True)
def _value_of_cell(field, x, y, size):
    """Return the value of the cell at a position relative to the corner of the grid, or of the nearest."""
    rows, cols = field.shape
    row, col = int(math.floor(y / size)), int(math.floor(x / size))
    return field[min(max(row, 0), rows - 1), min(max(col, 0), cols - 1)]


@numba.njit(cache=True)
def _has_to_leave(progress, stamp, has_arrived, remaining, rest, goal_count):
    """Return whether a pedestrian goes to its next goal: it has rested at this one or makes no progress.

    Args:
        progress: (3,) of the time until which it rests [s], its shortest remaining path so far [m] and the
            time of its last progress [s]; changed in place.
        stamp: Simulated time [s].
        has_arrived: Whether it is at its goal.
        remaining: Length of the remaining path [m].
        rest: Time that it rests at each goal [s].
        goal_count: Number of its goals.
    """
    is_resting = stamp < progress[0]
    if has_arrived or is_resting or remaining < progress[1] - PROGRESS_DISTANCE:
        progress[1], progress[2] = remaining, stamp
    if is_resting or goal_count == 1 or not (has_arrived or stamp - progress[2] > PATIENCE):
        return False
    progress[1], progress[2] = math.inf, stamp
    progress[0] = stamp + rest if has_arrived else stamp
    return True
