"""Homes: rooms with doors and furniture."""

import math
from dataclasses import dataclass

import numpy as np

from laboratory.generators.buildings import Buildings, Plan
from laboratory.generators.furniture import Furniture, Style
from laboratory.generators.rooms import Room, floor_plan

AREAS = 30.0, 300.0
PIECE, AREA_OF_A_PIECE = Style((0.4, 1.8), (0.4, 1.8)), 5.0


@dataclass(frozen=True)
class Homes(Buildings):
    """Rectangles cut into rooms that doors connect."""

    kind, stream, areas = "home", 42, AREAS
    least: float = AREAS[0]
    largest: float = AREAS[1]

    def draw(self, area: float, rng: np.random.Generator) -> Plan:
        width = math.sqrt(area * rng.uniform(0.7, 1.4))
        outline = Room(0.0, 0.0, width, area / width)
        floor = floor_plan(outline, rng)
        start = floor.rooms[int(rng.integers(len(floor.rooms)))].middle
        furniture = Furniture(outline, floor.solids, start)
        for room in floor.rooms:
            furniture.fill(room, AREA_OF_A_PIECE, lambda room: PIECE.piece(room, rng))
        return Plan(floor.solids, furniture.pieces, start, floor.doorways)
