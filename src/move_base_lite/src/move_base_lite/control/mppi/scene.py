"""The surroundings of the robot as arrays for the MPPI kernels: clearance, cost to go, dynamic obstacles."""

import math
from typing import NamedTuple

import numba
import numpy as np

from move_base_lite.control.local_planner import ControlContext, Plan
from move_base_lite.costmap import INSCRIBED, LETHAL, CostmapWindow
from move_base_lite.costmap.resampling import resample_costs
from move_base_lite.errors import ControlError
from move_base_lite.planning.wavefront import NEUTRAL, cost_to_go
from planar import Pose2
from planar.geometry.distance_field import distance_field

# Obstacle cells within this distance of a dynamic obstacle belong to it [m].
OBSTACLE_MARGIN = 0.1
# Value of unknown distances and costs to go [m].
FAR = 1e3
# Highest cost of a cell that can be entered.
MAX_GLOBAL_COST = INSCRIBED - 1
# Factor that covers the rounding of squared distances.
ROUNDING = 1.0 + 1e-6


class MppiScene(NamedTuple):
    """Surroundings of the robot: arrays, then numbers (see ARRAYS).

    Attributes:
        clearance: (rows, cols) distance to the nearest static obstacle [m].
        to_go: (rows, cols) cost to go to the plan's end in the window [m].
        outline_xy: (N, 2) footprint points in the base frame [m].
        dynamic_obstacles: (N, 5), see ControlContext.
        origin_x: Lower left corner of the grids in the local frame [m].
        origin_y: Lower left corner of the grids in the local frame [m].
        cells_per_metre: Inverse of the resolution.
        inscribed_radius: Inscribed radius of the footprint [m].
        circumscribed_radius: Circumscribed radius of the footprint [m].
        half_length: Half the length of the box around the footprint, centred at the base [m].
        half_width: Half its width [m].
    """

    clearance: np.ndarray
    to_go: np.ndarray
    outline_xy: np.ndarray
    dynamic_obstacles: np.ndarray
    origin_x: float
    origin_y: float
    cells_per_metre: float
    inscribed_radius: float
    circumscribed_radius: float
    half_length: float
    half_width: float


# The first fields of MppiScene are arrays.
ARRAYS = 4


def scene_of(context: ControlContext, plan: Plan, use_global_costmap: bool) -> MppiScene:
    """Compute clearance and cost to go around the robot.

    Args:
        context: Robot state, costmaps and dynamic obstacles.
        plan: Plan to follow; the cost to go leads to its last free point in the window.
        use_global_costmap: Whether obstacles that only the global costmap contains count too.

    Raises:
        ControlError: The plan is blocked within the window.
    """
    costmap, dynamic_obstacles = context.costmap, context.dynamic_obstacles
    costs = costs_with_global(context) if use_global_costmap else costmap.costs
    window = costmap.window
    return MppiScene(
        clearance=distance_field(_static_obstacles(costs, window, dynamic_obstacles), window.resolution, FAR),
        to_go=_cost_to_go(costs, window, plan.path_xy),
        outline_xy=costmap.outline_xy,
        dynamic_obstacles=dynamic_obstacles,
        origin_x=window.origin_x,
        origin_y=window.origin_y,
        cells_per_metre=1.0 / window.resolution,
        inscribed_radius=costmap.footprint.inscribed_radius,
        circumscribed_radius=costmap.footprint.circumscribed_radius,
        half_length=float(np.abs(costmap.footprint.corners_xy[:, 0]).max()),
        half_width=float(np.abs(costmap.footprint.corners_xy[:, 1]).max()),
    )


def costs_with_global(context: ControlContext) -> np.ndarray:
    """Merge obstacles of the global costmap into the costs of the local one.

    Inflated cells around obstacles that only the global costmap contains stay passable at the highest cost,
    as localization may be off by centimetres.

    Args:
        context: Costmaps, and robot pose in both frames.

    Returns:
        Costs of the local costmap's cells, uint8 (rows, cols).
    """
    local, global_window = context.costmap, context.global_costmap.window
    local_in_map = context.base_in_map @ context.base_in_local.inverse()
    origin = Pose2(global_window.origin_x, global_window.origin_y)
    known = resample_costs(
        local.window, local_in_map, context.global_costmap.costs, origin, global_window.resolution
    )
    both = np.where(known < LETHAL, np.maximum(local.costs, np.minimum(known, MAX_GLOBAL_COST)), local.costs)
    both[known == LETHAL] = LETHAL
    return both


def _cost_to_go(costs: np.ndarray, window: CostmapWindow, path_xy: np.ndarray) -> np.ndarray:
    """Cost to go, float32 (rows, cols) [m], to the path's last free point in the window."""
    cells = np.floor((path_xy - (window.origin_x, window.origin_y)) / window.resolution)
    field = cost_to_go(costs, cells[:, ::-1].astype(np.int64))
    if field is None:
        raise ControlError("the plan is blocked as far as the local costmap shows it")
    return field * np.float32(window.resolution / NEUTRAL)


def _static_obstacles(costs: np.ndarray, window: CostmapWindow, dynamic_obstacles: np.ndarray) -> np.ndarray:
    """Mask (rows, cols) of the static obstacles: lethal cells without those of dynamic obstacles."""
    obstacles = costs >= LETHAL
    for x, y, _, _, radius in dynamic_obstacles:
        bounds = window.bounds_around(x, y, radius + OBSTACLE_MARGIN)
        block = obstacles[slice(*bounds[:2]), slice(*bounds[2:])]
        rows, cols = np.nonzero(block)
        apart_x = window.origin_x + (bounds[2] + cols + 0.5) * window.resolution - x
        apart_y = window.origin_y + (bounds[0] + rows + 0.5) * window.resolution - y
        is_dynamic = np.hypot(apart_x, apart_y) < radius + OBSTACLE_MARGIN
        block[rows[is_dynamic], cols[is_dynamic]] = False
    return obstacles


@numba.njit(cache=True)
def footprint_clearance(scene, x, y, c, s, exact_below):
    """Compute a lower bound of the distance from the footprint to the nearest static obstacle.

    Args:
        scene: MppiScene.
        x: Robot position in the local frame [m].
        y: Robot position in the local frame [m].
        c: Cosine of the robot's heading.
        s: Sine of the robot's heading.
        exact_below: Clearance above which a coarse bound is sufficient [m].

    Returns:
        Distance [m]; in collision, minus the number of footprint points in collision. Outside of the window
        is an obstacle.
    """
    rows, cols = scene.clearance.shape
    cells = scene.cells_per_metre
    base_col = (x - scene.origin_x) * cells
    base_row = (y - scene.origin_y) * cells
    contacts, nearest = 0, np.float32(FAR)
    if not (0.0 <= base_row < rows and 0.0 <= base_col < cols):
        contacts = 1
    else:
        centre_clearance = scene.clearance[np.uint32(base_row), np.uint32(base_col)]
        if centre_clearance - scene.circumscribed_radius > exact_below:
            return float(centre_clearance - scene.circumscribed_radius)
        if centre_clearance < scene.inscribed_radius:
            contacts = 1
    c, s = c * cells, s * cells
    margin = scene.circumscribed_radius * cells + 1.0
    if margin <= base_row < rows - margin and margin <= base_col < cols - margin and contacts == 0:
        clearance = _least_clearance(scene, base_row, base_col, c, s)
        if clearance > 0.0:
            return float(clearance)
    for i in range(scene.outline_xy.shape[0]):
        along, across = scene.outline_xy[i, 0], scene.outline_xy[i, 1]
        row = base_row + s * along + c * across
        col = base_col + c * along - s * across
        if not (0.0 <= row < rows and 0.0 <= col < cols):
            contacts += 1
            continue
        clearance = scene.clearance[np.uint32(row), np.uint32(col)]
        if clearance == 0.0:
            contacts += 1
        else:
            nearest = min(nearest, clearance)
    return float(nearest) if contacts == 0 else -float(contacts)


@numba.njit(cache=True)
def _least_clearance(scene, base_row, base_col, c, s):
    """Least clearance of an outline within the window; free of branches, as most are not in collision."""
    least = np.float32(FAR)
    for i in range(scene.outline_xy.shape[0]):
        along, across = scene.outline_xy[i, 0], scene.outline_xy[i, 1]
        row = base_row + s * along + c * across
        col = base_col + c * along - s * across
        least = min(least, scene.clearance[np.uint32(row), np.uint32(col)])
    return least


@numba.njit(cache=True)
def dynamic_obstacle_clearance(scene, x, y, c, s, seconds, exact_below):
    """Compute the distance from the robot to the nearest dynamic obstacle at a future time.

    The robot is where its circumscribed circle and the box around its footprint overlap.

    Args:
        scene: MppiScene.
        x: Robot position in the local frame [m].
        y: Robot position in the local frame [m].
        c: Cosine of the robot's heading.
        s: Sine of the robot's heading.
        seconds: Time from now [s].
        exact_below: Largest result [m].
    """
    nearest = exact_below
    for i in range(scene.dynamic_obstacles.shape[0]):
        obstacle_x, obstacle_y, v_x, v_y, radius = scene.dynamic_obstacles[i]
        off_x, off_y = obstacle_x + seconds * v_x - x, obstacle_y + seconds * v_y - y
        reach = (nearest + radius + scene.circumscribed_radius) * ROUNDING
        if off_x * off_x + off_y * off_y < reach * reach:
            beyond_x = max(abs(c * off_x + s * off_y) - scene.half_length, 0.0)
            beyond_y = max(abs(c * off_y - s * off_x) - scene.half_width, 0.0)
            from_circle = math.hypot(off_x, off_y) - scene.circumscribed_radius
            nearest = min(nearest, max(from_circle, math.hypot(beyond_x, beyond_y)) - radius)
    return nearest


@numba.njit(cache=True)
def value_at(field, scene, x, y):
    """Interpolate a field bilinearly; FAR where it is unknown.

    Args:
        field: (rows, cols), values at the centres of the cells.
        scene: MppiScene, for the position of the cells.
        x: Position in the local frame [m].
        y: Position in the local frame [m].
    """
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
    """The same if some of the four cells are unknown; ``u``, ``w``: offsets from the first cell, 0 to 1."""
    total, weight = 0.0, 0.0
    for i in range(2):
        for j in range(2):
            value = field[row + i, col + j]
            if value < np.inf:
                share = (u if i else 1.0 - u) * (w if j else 1.0 - w)
                total += share * value
                weight += share
    return total / weight if weight > 0.0 else FAR
