"""Headings along a path (global_planner's orientation filter), and what a path costs."""

import math

import numpy as np

from move_base_lite.costmap import INSCRIBED, CostmapWindow
from move_base_lite.planning.wavefront import FACTOR, NEUTRAL
from planar import wrap

NONE, FORWARD, INTERPOLATE, FORWARD_THEN_INTERPOLATE, BACKWARD, LEFTWARD, RIGHTWARD = range(7)
# Radians off the last step's direction up to which a path counts as straight.
STRAIGHT = 0.35
_TURNED = {FORWARD: 0.0, BACKWARD: np.pi, LEFTWARD: np.pi / 2.0, RIGHTWARD: -np.pi / 2.0}


def headings_along(path_xy: np.ndarray, mode: int, start_yaw: float, goal_yaw: float) -> np.ndarray:
    """Yaws (N,) at the points of a path (N, 2); the last is always the goal's.

    ``mode``: 0 none, 1 forward, 2 evenly from start to goal, 3 forward, the straight end evenly, 4 backward,
    5 leftward, 6 rightward.
    """
    yaws = np.zeros(len(path_xy))
    if mode == INTERPOLATE:
        yaws = start_yaw + np.linspace(0.0, 1.0, len(path_xy)) * wrap(goal_yaw - start_yaw)
    elif mode != NONE and len(path_xy) > 1:
        steps = np.diff(path_xy, axis=0)
        along = np.arctan2(steps[:, 1], steps[:, 0])
        yaws[:-1] = along + _TURNED.get(mode, 0.0)
        if mode == FORWARD_THEN_INTERPOLATE:
            bends = np.flatnonzero(np.abs(wrap(along - along[-1])) > STRAIGHT)
            first = int(bends[-1]) + 1 if len(bends) else 0
            shares = np.linspace(0.0, 1.0, len(path_xy) - first)
            yaws[first:] = along[-1] + shares * wrap(goal_yaw - along[-1])
    if len(yaws):
        yaws[-1] = goal_yaw
    return wrap(yaws)


def path_cost(costs: np.ndarray, window: CostmapWindow, path_xy: np.ndarray) -> float:
    """What navfn would pay for a path (N, 2), in neutral metres; inf where it cannot be driven."""
    cells = np.floor((path_xy - (window.origin_x, window.origin_y)) / window.resolution).astype(np.int64)
    below = costs[cells[1:, 1], cells[1:, 0]].astype(float)
    if (below >= INSCRIBED).any():
        return math.inf
    lengths = np.linalg.norm(np.diff(path_xy, axis=0), axis=1)
    return float((lengths * (1.0 + FACTOR / NEUTRAL * below)).sum())
