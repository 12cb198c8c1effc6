"""Headings along a path (global_planner's orientation filter), and the cost of a path."""

import math

import numpy as np

from move_base_lite.costmap import INSCRIBED, CostmapWindow
from move_base_lite.planning.wavefront import FACTOR, NEUTRAL
from planar import wrap

NONE, FORWARD, INTERPOLATE, FORWARD_THEN_INTERPOLATE, BACKWARD, LEFTWARD, RIGHTWARD = range(7)
# Angle to the last step within which the end of a path counts as straight [rad].
STRAIGHT = 0.35
_ROTATION = {FORWARD: 0.0, BACKWARD: np.pi, LEFTWARD: np.pi / 2.0, RIGHTWARD: -np.pi / 2.0}


def headings_along(path_xy: np.ndarray, mode: int, start_yaw: float, goal_yaw: float) -> np.ndarray:
    """Compute headings along a path (global_planner: OrientationFilter).

    Args:
        path_xy: (N, 2) [m].
        mode: 0 none, 1 forward, 2 interpolated from start to goal, 3 forward and the straight end
            interpolated, 4 backward, 5 leftward, 6 rightward.
        start_yaw: Heading at the start [rad].
        goal_yaw: Heading at the goal [rad]; always that of the last point.

    Returns:
        Yaws (N,) [rad].
    """
    yaws = np.zeros(len(path_xy))
    if mode == INTERPOLATE:
        yaws = start_yaw + np.linspace(0.0, 1.0, len(path_xy)) * wrap(goal_yaw - start_yaw)
    elif mode != NONE and len(path_xy) > 1:
        steps = np.diff(path_xy, axis=0)
        along = np.arctan2(steps[:, 1], steps[:, 0])
        yaws[:-1] = along + _ROTATION.get(mode, 0.0)
        if mode == FORWARD_THEN_INTERPOLATE:
            bends = np.flatnonzero(np.abs(wrap(along - along[-1])) > STRAIGHT)
            first = int(bends[-1]) + 1 if len(bends) else 0
            shares = np.linspace(0.0, 1.0, len(path_xy) - first)
            yaws[first:] = along[-1] + shares * wrap(goal_yaw - along[-1])
    if len(yaws):
        yaws[-1] = goal_yaw
    return wrap(yaws)


def path_cost(costs: np.ndarray, window: CostmapWindow, path_xy: np.ndarray) -> float:
    """Compute navfn's cost of a path.

    Args:
        costs: uint8 (rows, cols).
        window: Position and resolution of the grid.
        path_xy: (N, 2), in the window's frame [m].

    Returns:
        Cost in metres of free space; inf if a cell of the path is blocked.
    """
    cells = np.floor((path_xy - (window.origin_x, window.origin_y)) / window.resolution).astype(np.int64)
    below = costs[cells[1:, 1], cells[1:, 0]].astype(float)
    if (below >= INSCRIBED).any():
        return math.inf
    lengths = np.linalg.norm(np.diff(path_xy, axis=0), axis=1)
    return float((lengths * (1.0 + FACTOR / NEUTRAL * below)).sum())
