"""Generated offices: a corridor with rooms on both sides, and desks."""

from dataclasses import dataclass

import numpy as np

from laboratory.generators.buildings import BuildingGenerator, BuildingLayout
from laboratory.generators.floor_plan import FloorPlan, Rectangle, WallSegment, outer_walls
from laboratory.generators.furniture import Furniture, FurnitureStyle

AREAS = 60.0, 400.0
# Ranges [m]: width of the corridor, depth and width of the rooms.
CORRIDOR_WIDTH, ROOM_DEPTH, ROOM_WIDTH = (1.6, 2.4), (3.2, 4.8), (3.0, 4.5)
# Share of walls between two rooms that have a door, which gives alternative routes.
CONNECTING_DOOR_SHARE = 0.4
# Desks along either axis, and chairs; one piece for AREA_OF_A_PIECE square metres.
PIECES = (
    FurnitureStyle((1.2, 1.6), (0.6, 0.8)),
    FurnitureStyle((0.6, 0.8), (1.2, 1.6)),
    FurnitureStyle((0.4, 0.5), (0.4, 0.5), 0.2, 0.2),
)
AREA_OF_A_PIECE = 4.0


@dataclass(frozen=True)
class Offices(BuildingGenerator):
    """Single floors; the robot starts in the corridor."""

    kind, stream, areas = "office", 47, AREAS
    min_area: float = AREAS[0]
    max_area: float = AREAS[1]

    def layout(self, area: float, rng: np.random.Generator) -> BuildingLayout:
        below, between, above = (
            float(rng.uniform(*size)) for size in (ROOM_DEPTH, CORRIDOR_WIDTH, ROOM_DEPTH)
        )
        outline = Rectangle(0.0, 0.0, area / (below + between + above), below + between + above)
        lower = _room_row(Rectangle(0.0, 0.0, outline.width, below), below, rng)
        upper = _room_row(Rectangle(0.0, below + between, outline.width, above), below + between, rng)
        outside = FloorPlan([], outer_walls(outline), [])
        walls = [*outside.solids, *lower.solids, *upper.solids]
        start = float(rng.uniform(1.0, outline.width - 1.0)), below + between / 2.0
        furniture = Furniture(outline, walls, start)
        for room in (*lower.rooms, *upper.rooms):
            furniture.fill(room, AREA_OF_A_PIECE, lambda room: _piece(room, rng))
        return BuildingLayout(walls, furniture.pieces, start, [*lower.doorways, *upper.doorways])


def _piece(room: Rectangle, rng: np.random.Generator) -> Rectangle:
    return PIECES[int(rng.integers(len(PIECES)))].piece(room, rng)


def _room_row(side: Rectangle, corridor: float, rng: np.random.Generator) -> FloorPlan:
    """A row of rooms, each with a door to the corridor, whose wall is at y = ``corridor``; no outer walls."""
    floor = FloorPlan([], [], [])
    count = max(int(side.width / rng.uniform(*ROOM_WIDTH)), 1)
    shares = rng.uniform(0.85, 1.15, count)
    ends = np.concatenate(([0.0], np.cumsum(shares) / shares.sum() * side.width)).tolist()
    for start, end in zip(ends, ends[1:]):
        floor.rooms.append(Rectangle(start, side.y, end - start, side.depth))
        floor.add_with_door(WallSegment(start, corridor, end, corridor), rng)
    for x in ends[1:-1]:
        wall = WallSegment(x, side.y, x, side.y + side.depth)
        if rng.random() < CONNECTING_DOOR_SHARE:
            floor.add_with_door(wall, rng)
        else:
            floor.walls.append(wall)
    return floor
