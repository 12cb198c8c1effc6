"""What is around the robot, as the kernels of path integral control look at it."""

import math
from typing import NamedTuple

import numba
import numpy as np

from move_base_lite.control.local_planner import Plan, Situation
from move_base_lite.costmap import LETHAL, LayeredCostmap
from move_base_lite.errors import ControlError
from move_base_lite.planning.wavefront import NEUTRAL, cost_to_go
from planar.geometry.distance_field import distance_field

# Metres around what moves within which obstacles are taken for it.
AROUND_MOVER = 0.1
FAR = 1e3


class Scene(NamedTuple):
    """What there is around the robot: fields (rows, cols) in metres, and the outline it fills itself."""

    clearance: np.ndarray
    to_go: np.ndarray
    origin_x: float
    origin_y: float
    resolution: float
    outline_xy: np.ndarray
    inscribed_radius: float
    circumscribed_radius: float
    movers: np.ndarray


def scene_of(situation: Situation, plan: Plan) -> Scene:
    """Clearance and cost to go around the robot. Raises ControlError if the plan is blocked."""
    costmap, movers = situation.costmap, situation.movers
    window = costmap.window
    return Scene(
        clearance=distance_field(_standing(costmap, movers), window.resolution, FAR),
        to_go=_cost_to_go(costmap, plan.path_xy),
        origin_x=window.origin_x,
        origin_y=window.origin_y,
        resolution=window.resolution,
        outline_xy=costmap.outline_xy,
        inscribed_radius=costmap.footprint.inscribed_radius,
        circumscribed_radius=costmap.footprint.circumscribed_radius,
        movers=movers,
    )


def _cost_to_go(costmap: LayeredCostmap, path_xy: np.ndarray) -> np.ndarray:
    """Metres, float32 (rows, cols), to the path's last point in the window that is free."""
    window = costmap.window
    cells = np.floor((path_xy - (window.origin_x, window.origin_y)) / window.resolution)
    field = cost_to_go(costmap.costs, cells[:, ::-1].astype(np.int64))
    if field is None:
        raise ControlError("all of the plan in sight is blocked")
    return field * np.float32(window.resolution / NEUTRAL)


def _standing(costmap: LayeredCostmap, movers: np.ndarray) -> np.ndarray:
    """Which cells (rows, cols) are obstacles that stay: those that movers are seen in will have gone."""
    obstacles, window = costmap.costs >= LETHAL, costmap.window
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
def room_at(scene, x, y, yaw):
    """Metres from the outline to the nearest obstacle, at least; if it touches, minus how many points do.

    All that is outside the window counts as an obstacle.
    """
    rows, cols = scene.clearance.shape
    base_col = (x - scene.origin_x) / scene.resolution
    base_row = (y - scene.origin_y) / scene.resolution
    row, col = math.floor(base_row), math.floor(base_col)
    touching, nearest = 0, FAR
    if row < 0 or row >= rows or col < 0 or col >= cols:
        touching = 1
    else:
        around = scene.clearance[row, col]
        if around > 2.0 * scene.circumscribed_radius:
            return around - scene.circumscribed_radius
        if around < scene.inscribed_radius:
            touching = 1
    c, s = math.cos(yaw) / scene.resolution, math.sin(yaw) / scene.resolution
    for i in range(scene.outline_xy.shape[0]):
        along, across = scene.outline_xy[i]
        row = math.floor(base_row + s * along + c * across)
        col = math.floor(base_col + c * along - s * across)
        if row < 0 or row >= rows or col < 0 or col >= cols or scene.clearance[row, col] == 0.0:
            touching += 1
        else:
            nearest = min(nearest, scene.clearance[row, col])
    return nearest if touching == 0 else -float(touching)


@numba.njit(cache=True)
def room_beside_movers(scene, x, y, seconds):
    """Metres from the robot's circle to the nearest of what moves, so many seconds from now."""
    nearest = FAR
    for i in range(scene.movers.shape[0]):
        mover_x, mover_y, v_x, v_y, radius = scene.movers[i]
        apart = math.hypot(mover_x + seconds * v_x - x, mover_y + seconds * v_y - y)
        nearest = min(nearest, apart - radius - scene.circumscribed_radius)
    return nearest


@numba.njit(cache=True)
def value_at(field, scene, x, y):
    """A field between the centres of its cells; FAR where it is not known."""
    rows, cols = field.shape
    u = (y - scene.origin_y) / scene.resolution - 0.5
    w = (x - scene.origin_x) / scene.resolution - 0.5
    row, col = int(math.floor(u)), int(math.floor(w))
    if row < 0 or row >= rows - 1 or col < 0 or col >= cols - 1:
        return FAR
    u, w = u - row, w - col
    total, weight = 0.0, 0.0
    for i in range(2):
        for j in range(2):
            value = field[row + i, col + j]
            if value < np.inf:
                share = (u if i else 1.0 - u) * (w if j else 1.0 - w)
                total += share * value
                weight += share
    return total / weight if weight > 0.0 else FAR
