"""Plans from maps, as from SLAM: the YAML and image pair of map_server."""

import math
from pathlib import Path
from typing import Tuple

import numpy as np
from scipy.ndimage import binary_closing, label

from home_builder.errors import ImportPlanError
from home_builder.imports.joints import join_walls, rounded
from home_builder.imports.outlines import furniture_from_cells
from home_builder.imports.wall_strips import SolidCells, straight_walls
from home_builder.plan.model import DOOR, HomePlan, Point
from planar import FREE, OCCUPIED, UNKNOWN, OccupancyGrid, load_map
from planar.geometry.distance_field import distance_field

# Unknown cells between two faces of a wall that are so close are taken for its inside [m].
INSIDE_OF_WALL = 0.3
# Clearance of the robot at its start: wanted at the origin, and at least anywhere [m].
START_CLEARANCE, LEAST_CLEARANCE = 0.3, 0.2
# Share of free cells in a gap that is a door.
FREE_SHARE = 0.7
CELL = 0.05


def import_map(path: Path) -> HomePlan:
    """Make a plan of a map.

    Args:
        path: YAML file of the map.

    Returns:
        The plan, in the frame of the map up to a shift of less than a cell.

    Raises:
        MapFileError: The map cannot be read.
        ImportPlanError: It has no walls, or no free space to start in.
    """
    return plan_of_map(load_map(path), path.stem)


def plan_of_map(grid: OccupancyGrid, name: str) -> HomePlan:
    """Make a plan of an occupancy grid; see ``import_map``."""
    occupied = grid.cells == OCCUPIED
    if not occupied.any():
        raise ImportPlanError(f"{name}: the map has no occupied cells, so there are no walls to import")
    corner = _aligned(grid)
    inside = max(1, int(round(INSIDE_OF_WALL / grid.resolution)))
    closed = binary_closing(np.pad(occupied, inside), np.ones((inside, inside)))[
        inside:-inside, inside:-inside
    ]
    solid = SolidCells(occupied | (closed & (grid.cells == UNKNOWN)), grid.resolution, corner)
    strips, rest = straight_walls(solid)
    walls = join_walls(strips, grid.resolution, _free_gaps(grid, corner))
    furniture = furniture_from_cells(SolidCells(rest & occupied, grid.resolution, corner))
    return HomePlan(name, tuple(map(rounded, walls)), tuple(furniture), start=start_of(grid, corner, name))


def _aligned(grid: OccupancyGrid) -> Point:
    """Return the lower left corner, shifted so that edges of cells are multiples of their size."""
    x, y = (round(each / grid.resolution) * grid.resolution for each in (grid.origin.x, grid.origin.y))
    return x, y


def _free_gaps(grid: OccupancyGrid, corner: Point):
    """Return the judge of gaps: a door is free, as the robot or its laser has passed it."""

    def kind(start: Point, end: Point, thickness: float) -> str:
        count = max(2, int(math.dist(start, end) / grid.resolution))
        shares = np.linspace(0.1, 0.9, count)  # not the cells of the walls' ends
        line_xy = np.outer(1.0 - shares, start) + np.outer(shares, end)
        cells = np.floor((line_xy[:, ::-1] - corner[::-1]) / grid.resolution).astype(int)
        values = grid.cells[tuple(cells[grid.contains(cells)].T)]
        is_free = len(values) == count and (values == FREE).mean() >= FREE_SHARE
        return DOOR if is_free and not (values == OCCUPIED).any() else ""

    return kind


def start_of(grid: OccupancyGrid, corner: Tuple[float, float], name: str) -> Point:
    """Return where the robot starts: at the map's origin, as SLAM does, or where there is most room.

    Args:
        grid: The map.
        corner: Its lower left corner in the plan [m].
        name: Name of the map, for the message.

    Raises:
        ImportPlanError: There is no room for the robot.
    """
    clearance = distance_field(grid.cells != FREE, grid.resolution)
    origin = np.floor(-np.array(corner[::-1]) / grid.resolution + 0.5).astype(int)
    if grid.contains(origin)[0] and clearance[tuple(origin)] > START_CLEARANCE:
        return 0.0, 0.0
    regions, count = label(clearance > LEAST_CLEARANCE)
    if not count:
        raise ImportPlanError(f"{name}: there is no free space in which the robot fits")
    largest = 1 + int(np.argmax(np.bincount(regions.ravel())[1:]))
    row, col = np.unravel_index(np.argmax(np.where(regions == largest, clearance, 0.0)), regions.shape)
    x, y = (
        round((corner[0] + col * grid.resolution) / CELL) * CELL,
        round((corner[1] + row * grid.resolution) / CELL) * CELL,
    )
    return round(x, 4), round(y, 4)
