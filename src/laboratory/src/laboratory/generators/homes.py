"""Generated homes: rooms with doors and furniture."""

import math
from dataclasses import dataclass

import numpy as np

from laboratory.generators.buildings import BuildingGenerator, BuildingLayout
from laboratory.generators.floor_plan import Rectangle, generate_floor_plan
from laboratory.generators.furniture import Furniture, FurnitureStyle

AREAS = 30.0, 300.0
PIECE, AREA_OF_A_PIECE = FurnitureStyle((0.4, 1.8), (0.4, 1.8)), 5.0


@dataclass(frozen=True)
class Homes(BuildingGenerator):
    """Rectangles split into rooms that are connected by doors."""

    kind, stream, areas = "home", 42, AREAS
    min_area: float = AREAS[0]
    max_area: float = AREAS[1]

    def layout(self, area: float, rng: np.random.Generator) -> BuildingLayout:
        width = math.sqrt(area * rng.uniform(0.7, 1.4))
        outline = Rectangle(0.0, 0.0, width, area / width)
        floor = generate_floor_plan(outline, rng)
        start = floor.rooms[int(rng.integers(len(floor.rooms)))].middle
        furniture = Furniture(outline, floor.solids, start)
        for room in floor.rooms:
            furniture.fill(room, AREA_OF_A_PIECE, lambda room: PIECE.piece(room, rng))
        return BuildingLayout(floor.solids, furniture.pieces, start, floor.doorways)
