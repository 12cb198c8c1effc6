"""What is around the robot, as the kernels of path integral control look at it."""

import math
from typing import NamedTuple

import numba
import numpy as np

from move_base_lite.control.local_planner import Plan, Situation
from move_base_lite.control.mppi.remembered import costs_with_remembered
from move_base_lite.costmap import LETHAL, CostmapWindow
from move_base_lite.errors import ControlError
from move_base_lite.planning.wavefront import NEUTRAL, cost_to_go
from planar.geometry.distance_field import distance_field

# Metres around what moves within which obstacles are taken for it.
AROUND_MOVER = 0.1
FAR = 1e3
# Of a distance, by which a square that stands for it may be wrong, and far more.
ROUNDING = 1.0 + 1e-6


class Scene(NamedTuple):
    """What there is around the robot: fields (rows, cols) in metres, the outline it fills itself, and what
    moves; then numbers.
    """

    clearance: np.ndarray
    to_go: np.ndarray
    outline_xy: np.ndarray
    movers: np.ndarray
    origin_x: float
    origin_y: float
    cells_per_metre: float
    inscribed_radius: float
    circumscribed_radius: float


ARRAYS = 4


def scene_of(situation: Situation, plan: Plan, heeds_remembered: bool) -> Scene:
    """Clearance and cost to go around the robot. Raises ControlError if the plan is blocked."""
    costmap, movers = situation.costmap, situation.movers
    costs = costs_with_remembered(situation) if heeds_remembered else costmap.costs
    window = costmap.window
    return Scene(
        clearance=distance_field(_standing(costs, window, movers), window.resolution, FAR),
        to_go=_cost_to_go(costs, window, plan.path_xy),
        outline_xy=costmap.outline_xy,
        movers=movers,
        origin_x=window.origin_x,
        origin_y=window.origin_y,
        cells_per_metre=1.0 / window.resolution,
        inscribed_radius=costmap.footprint.inscribed_radius,
        circumscribed_radius=costmap.footprint.circumscribed_radius,
    )


def _cost_to_go(costs: np.ndarray, window: CostmapWindow, path_xy: np.ndarray) -> np.ndarray:
    """Metres, float32 (rows, cols), to the path's last point in the window that is free."""
    cells = np.floor((path_xy - (window.origin_x, window.origin_y)) / window.resolution)
    field = cost_to_go(costs, cells[:, ::-1].astype(np.int64))
    if field is None:
        raise ControlError("all of the plan in sight is blocked")
    return field * np.float32(window.resolution / NEUTRAL)


def _standing(costs: np.ndarray, window: CostmapWindow, movers: np.ndarray) -> np.ndarray:
    """Which cells (rows, cols) are obstacles that stay: those that movers are seen in will have gone."""
    obstacles = costs >= LETHAL
    for x, y, _, _, radius in movers:
        bounds = window.bounds_around(x, y, radius + AROUND_MOVER)
        block = obstacles[slice(*bounds[:2]), slice(*bounds[2:])]
        rows, cols = np.nonzero(block)
        apart_x = window.origin_x + (bounds[2] + cols + 0.5) * window.resolution - x
        apart_y = window.origin_y + (bounds[0] + rows + 0.5) * window.resolution - y
        is_its_own = np.hypot(apart_x, apart_y) < radius + AROUND_MOVER
        block[rows[is_its_own], cols[is_its_own]] = False
    return obstacles


@numba.njit(cache=True)
def room_at(scene, x, y, c, s, enough):
    """Metres from the outline to the nearest obstacle, at least; if it touches, minus how many points do.

    ``c``, ``s``: cosine and sine of the heading; ``enough``: metres from which on it need not be exact. All
    that is outside the window counts as an obstacle.
    """
    rows, cols = scene.clearance.shape
    cells = scene.cells_per_metre
    base_col = (x - scene.origin_x) * cells
    base_row = (y - scene.origin_y) * cells
    touching, nearest = 0, np.float32(FAR)
    if not (0.0 <= base_row < rows and 0.0 <= base_col < cols):
        touching = 1
    else:
        around = scene.clearance[np.uint32(base_row), np.uint32(base_col)]
        if around - scene.circumscribed_radius > enough:
            return float(around - scene.circumscribed_radius)
        if around < scene.inscribed_radius:
            touching = 1
    c, s = c * cells, s * cells
    margin = scene.circumscribed_radius * cells + 1.0
    if margin <= base_row < rows - margin and margin <= base_col < cols - margin and touching == 0:
        room = _least_clearance(scene, base_row, base_col, c, s)
        if room > 0.0:
            return float(room)
    for i in range(scene.outline_xy.shape[0]):
        along, across = scene.outline_xy[i, 0], scene.outline_xy[i, 1]
        row = base_row + s * along + c * across
        col = base_col + c * along - s * across
        if not (0.0 <= row < rows and 0.0 <= col < cols):
            touching += 1
            continue
        room = scene.clearance[np.uint32(row), np.uint32(col)]
        if room == 0.0:
            touching += 1
        else:
            nearest = min(nearest, room)
    return float(nearest) if touching == 0 else -float(touching)


@numba.njit(cache=True)
def _least_clearance(scene, base_row, base_col, c, s):
    """Of all points of an outline that lies within the window: without a branch, as most touch nothing."""
    least = np.float32(FAR)
    for i in range(scene.outline_xy.shape[0]):
        along, across = scene.outline_xy[i, 0], scene.outline_xy[i, 1]
        row = base_row + s * along + c * across
        col = base_col + c * along - s * across
        least = min(least, scene.clearance[np.uint32(row), np.uint32(col)])
    return least


@numba.njit(cache=True)
def room_beside_movers(scene, x, y, seconds, enough):
    """Metres from the robot's circle to the nearest of what moves, so many seconds from now.

    ``enough``: metres from which on it need not be told how many more those are.
    """
    nearest = enough
    for i in range(scene.movers.shape[0]):
        mover_x, mover_y, v_x, v_y, radius = scene.movers[i]
        off_x, off_y = mover_x + seconds * v_x - x, mover_y + seconds * v_y - y
        reach = (nearest + radius + scene.circumscribed_radius) * ROUNDING
        if off_x * off_x + off_y * off_y < reach * reach:
            nearest = min(nearest, math.hypot(off_x, off_y) - radius - scene.circumscribed_radius)
    return nearest


@numba.njit(cache=True)
def value_at(field, scene, x, y):
    """A field between the centres of its cells; FAR where it is not known."""
    rows, cols = field.shape
    cells = scene.cells_per_metre
    u = (y - scene.origin_y) * cells - 0.5
    w = (x - scene.origin_x) * cells - 0.5
    if not (0.0 <= u < rows - 1 and 0.0 <= w < cols - 1):
        return FAR
    row, col = np.uint32(u), np.uint32(w)
    u, w = u - float(row), w - float(col)
    below, right = row + np.uint32(1), col + np.uint32(1)
    low = (1.0 - w) * field[row, col] + w * field[row, right]
    high = (1.0 - w) * field[below, col] + w * field[below, right]
    value = (1.0 - u) * low + u * high
    return value if value < np.inf else _value_of_known(field, row, col, u, w)


@numba.njit(cache=True)
def _value_of_known(field, row, col, u, w):
    """The same where some of four cells are not known; ``u``, ``w``: from the first of them on, 0 to 1."""
    total, weight = 0.0, 0.0
    for i in range(2):
        for j in range(2):
            value = field[row + i, col + j]
            if value < np.inf:
                share = (u if i else 1.0 - u) * (w if j else 1.0 - w)
                total += share * value
                weight += share
    return total / weight if weight > 0.0 else FAR
