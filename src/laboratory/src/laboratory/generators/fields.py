"""Fields of cylinders as in BARN, another for each seed (Perille et al., 2020, section III)."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Tuple

import numpy as np
from scipy.ndimage import convolve

from laboratory.tasks.shortest_paths import ShortestPaths
from laboratory.worlds.barn import GOAL_IN_ODOM, START
from laboratory.worlds.solids import FLOOR, post, wall
from laboratory.worlds.source import Arena
from planar import Pose2
from planar.config.yaml_table import Table
from sim_bridge.views.true_map import true_map
from sim_bridge.world import World

# Cells along each side of the field, and metres: of a cell, of a cylinder's radius, of the robot's that a way
# must be wide enough for; where the field's middle is, and what its walls reach from and to.
CELLS, CELL, RADIUS, ROBOT_CLEARANCE = 30, 0.15, 0.075, 0.3
MIDDLE_XY, WALL_Y = (-2.25, 7.25), (0.5, 14.5)
# Shares of cells that are filled at first, and how often the automaton smooths them.
MIN_FILL, MAX_FILL, SMOOTHINGS = 0.18, 0.34, (2, 4)
# Of eight neighbours filled, from which on a cell fills, and up to which it empties.
BIRTH_NEIGHBOURS, DEATH_NEIGHBOURS = 5, 1
_STREAM = 44
_NEIGHBOURS = np.array([[1, 1, 1], [1, 0, 1], [1, 1, 1]])


@dataclass(frozen=True)
class CylinderFields:
    """BARN's start and goal, between walls, and what a cellular automaton grew in between."""

    def arena(self, seed: int) -> Arena:
        return _arena(seed)

    def files(self) -> Tuple[Path, ...]:
        return ()

    def arena_number(self, seed: int) -> int:
        return seed


@lru_cache(maxsize=64)
def _arena(seed: int) -> Arena:
    rng = np.random.default_rng([seed, _STREAM])
    goal = START @ GOAL_IN_ODOM
    while True:  # until there is a way through
        world = _world(seed, grow_cells(rng))
        grid = true_map(world, inside=(START.x, START.y))
        reference_length = ShortestPaths(grid, ROBOT_CLEARANCE).length((START, goal))
        if reference_length is not None:
            return Arena(world, None, world.name, reference_length)


def grow_cells(rng: np.random.Generator) -> np.ndarray:
    """Which cells are filled, (CELLS, CELLS)."""
    cells = rng.random((CELLS, CELLS)) < rng.uniform(MIN_FILL, MAX_FILL)
    for _ in range(rng.integers(*SMOOTHINGS, endpoint=True)):
        neighbours = convolve(cells.astype(int), _NEIGHBOURS, mode="constant")
        cells = (cells | (neighbours >= BIRTH_NEIGHBOURS)) & (neighbours > DEATH_NEIGHBOURS)
    return cells


def _world(seed: int, cells: np.ndarray) -> World:
    side, x, (first, last) = CELLS * CELL, MIDDLE_XY[0], WALL_Y
    walls = [
        wall("left", x - side / 2.0, (first + last) / 2.0, CELL, last - first),
        wall("right", x + side / 2.0, (first + last) / 2.0, CELL, last - first),
        wall("back", x, first, side, CELL),
    ]
    corner = np.array(MIDDLE_XY) - (side - CELL) / 2.0
    posts = [
        post(f"post_{number}", Pose2(*(corner + CELL * cell[::-1])), RADIUS, 1.0)
        for number, cell in enumerate(np.argwhere(cells))
    ]
    return World(f"field {seed}", (FLOOR, *walls, *posts))


def read_fields(table: Table, folder: Path) -> CylinderFields:
    """``fields: cylinders``."""
    table.allow_only("fields")
    table.choice("fields", ("cylinders",))
    return CylinderFields()
