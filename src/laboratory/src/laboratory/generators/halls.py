"""Generated halls: one large room with shelves or pillars, and pallets."""

import math
from dataclasses import dataclass
from typing import List, Sequence, Tuple

import numpy as np

from laboratory.generators.buildings import BuildingGenerator, BuildingLayout
from laboratory.generators.floor_plan import Rectangle, outer_walls
from laboratory.generators.furniture import Furniture, FurnitureStyle

AREAS = 80.0, 800.0
# Ranges [m]: width of an aisle, depth and length of a shelf, side of a pillar, gap between two pillars.
AISLE_WIDTH, SHELF_DEPTH, SHELF_LENGTH = (1.6, 2.6), (0.5, 1.2), (3.0, 8.0)
PILLAR_SIDE, PILLAR_GAP = (0.3, 0.6), (2.0, 4.0)
# Share of halls with shelves.
SHELVES_SHARE = 0.6
PALLET, AREA_OF_A_PALLET = FurnitureStyle((0.8, 1.2), (0.8, 1.2), 0.3, 0.3), 40.0
# Distance from the start position to walls, shelves and pillars [m].
START_CLEARANCE = 0.7


@dataclass(frozen=True)
class Halls(BuildingGenerator):
    """Warehouses and parking garages."""

    kind, stream, areas = "hall", 48, AREAS
    min_area: float = AREAS[0]
    max_area: float = AREAS[1]

    def layout(self, area: float, rng: np.random.Generator) -> BuildingLayout:
        width = math.sqrt(area * rng.uniform(0.8, 2.5))
        hall = Rectangle(0.0, 0.0, width, area / width)
        walls = [wall.solid for wall in outer_walls(hall)]
        obstacles = (_shelves if rng.random() < SHELVES_SHARE else _pillars)(hall, rng)
        start = _start(hall, obstacles, rng)
        pallets = Furniture(hall, [*walls, *obstacles], start)
        pallets.fill(hall, AREA_OF_A_PALLET, lambda hall: PALLET.piece(hall, rng))
        return BuildingLayout(walls, [*obstacles, *pallets.pieces], start)


def _shelves(hall: Rectangle, rng: np.random.Generator) -> List[Rectangle]:
    """Rows of shelves along x, separated by aisles in both directions."""
    aisle, shelf_depth, shelf_length = (
        float(rng.uniform(*size)) for size in (AISLE_WIDTH, SHELF_DEPTH, SHELF_LENGTH)
    )
    shelf_length = min(shelf_length, hall.width - 2.0 * aisle)
    rows, columns = (
        _evenly_spaced(hall.depth, shelf_depth, aisle),
        _evenly_spaced(hall.width, shelf_length, aisle),
    )
    return [Rectangle(x, y, shelf_length, shelf_depth) for y in rows for x in columns]


def _pillars(hall: Rectangle, rng: np.random.Generator) -> List[Rectangle]:
    side, gap = float(rng.uniform(*PILLAR_SIDE)), float(rng.uniform(*PILLAR_GAP))
    rows, columns = (_evenly_spaced(length, side, gap) for length in (hall.depth, hall.width))
    return [Rectangle(x, y, side, side) for y in rows for x in columns]


def _evenly_spaced(length: float, size: float, gap: float) -> List[float]:
    """Start coordinates of evenly spaced pieces along a length, with at least ``gap`` between them."""
    count = max(int((length - gap) / (size + gap)), 1)
    step = (length - count * size) / (count + 1) + size
    return [step * number - size for number in range(1, count + 1)]


def _start(hall: Rectangle, obstacles: Sequence[Rectangle], rng: np.random.Generator) -> Tuple[float, float]:
    """A random position away from walls and obstacles."""
    while True:
        x, y = (
            float(rng.uniform(START_CLEARANCE, side - START_CLEARANCE)) for side in (hall.width, hall.depth)
        )
        if all(piece.distance_to(x, y) > START_CLEARANCE for piece in obstacles):
            return x, y
