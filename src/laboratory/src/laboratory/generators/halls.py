"""Halls: one big room with rows of shelves, or with pillars, and pallets about."""

import math
from dataclasses import dataclass
from typing import List, Sequence, Tuple

import numpy as np

from laboratory.generators.buildings import Buildings, Plan
from laboratory.generators.furniture import Furniture, Style
from laboratory.generators.rooms import Room, walls_round

AREAS = 80.0, 800.0
# Metres, the least and the most: width of an aisle, depth and length of a row of shelves; side of a pillar,
# and from one to the next.
AISLE, DEEP, LONG = (1.6, 2.6), (0.5, 1.2), (3.0, 8.0)
PILLAR, APART = (0.3, 0.6), (2.0, 4.0)
# The share of halls with shelves.
WITH_SHELVES = 0.6
PALLET, AREA_OF_A_PALLET = Style((0.8, 1.2), (0.8, 1.2), 0.3, 0.3), 40.0
# Metres from where the robot starts to walls, shelves and pillars.
TO_SOLID = 0.7


@dataclass(frozen=True)
class Halls(Buildings):
    """What a warehouse or a garage is to a robot."""

    kind, stream, areas = "hall", 48, AREAS
    least: float = AREAS[0]
    largest: float = AREAS[1]

    def draw(self, area: float, rng: np.random.Generator) -> Plan:
        width = math.sqrt(area * rng.uniform(0.8, 2.5))
        hall = Room(0.0, 0.0, width, area / width)
        walls = [wall.solid for wall in walls_round(hall)]
        standing = (_shelves if rng.random() < WITH_SHELVES else _pillars)(hall, rng)
        start = _start(hall, standing, rng)
        pallets = Furniture(hall, [*walls, *standing], start)
        pallets.fill(hall, AREA_OF_A_PALLET, lambda hall: PALLET.piece(hall, rng))
        return Plan(walls, [*standing, *pallets.pieces], start)


def _shelves(hall: Room, rng: np.random.Generator) -> List[Room]:
    """Rows along x with aisles between them, all broken at the same places."""
    aisle, deep, long = (float(rng.uniform(*size)) for size in (AISLE, DEEP, LONG))
    long = min(long, hall.width - 2.0 * aisle)
    rows, columns = _spread(hall.depth, deep, aisle), _spread(hall.width, long, aisle)
    return [Room(x, y, long, deep) for y in rows for x in columns]


def _pillars(hall: Room, rng: np.random.Generator) -> List[Room]:
    side, apart = float(rng.uniform(*PILLAR)), float(rng.uniform(*APART))
    rows, columns = (_spread(length, side, apart) for length in (hall.depth, hall.width))
    return [Room(x, y, side, side) for y in rows for x in columns]


def _spread(length: float, size: float, gap: float) -> List[float]:
    """Where pieces of a size begin that stand evenly along a length, that far from each other at least."""
    count = max(int((length - gap) / (size + gap)), 1)
    step = (length - count * size) / (count + 1) + size
    return [step * number - size for number in range(1, count + 1)]


def _start(hall: Room, standing: Sequence[Room], rng: np.random.Generator) -> Tuple[float, float]:
    """Somewhere off the walls and what stands there."""
    while True:
        x, y = (float(rng.uniform(TO_SOLID, side - TO_SOLID)) for side in (hall.width, hall.depth))
        if all(piece.distance_to(x, y) > TO_SOLID for piece in standing):
            return x, y
