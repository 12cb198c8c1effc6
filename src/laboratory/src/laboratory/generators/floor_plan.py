"""Random floor plans: a rectangle is split recursively by walls with doors, so all rooms are connected."""

import math
from dataclasses import dataclass
from typing import List, NamedTuple, Tuple

import numpy as np

# Metres: smallest side of a room, width of a door, wall on either side of a door; square metres: a room is
# never split below the first area, and always above the second.
SMALLEST_SIDE, DOOR_WIDTH, DOOR_MARGIN = 2.4, 1.1, 0.5
MIN_SPLIT_AREA, MAX_ROOM_AREA = 12.0, 30.0
THICKNESS = 0.12


@dataclass(frozen=True)
class Rectangle:
    """Rectangle from (x, y) to (x + width, y + depth) [m]: a room, a wall or a piece of furniture."""

    x: float
    y: float
    width: float
    depth: float

    @property
    def area(self) -> float:
        return self.width * self.depth

    @property
    def middle(self) -> Tuple[float, float]:
        return self.x + self.width / 2.0, self.y + self.depth / 2.0

    @property
    def corners(self) -> Tuple[float, float, float, float]:
        """Minimum x and y, maximum x and y."""
        return self.x, self.y, self.x + self.width, self.y + self.depth

    def distance_to(self, x: float, y: float) -> float:
        """Return the distance to a point [m]; 0 inside."""
        off_x = max(self.x - x, x - self.x - self.width, 0.0)
        return math.hypot(off_x, max(self.y - y, y - self.y - self.depth, 0.0))


@dataclass(frozen=True)
class WallSegment:
    """Centre line of an axis-aligned wall."""

    x1: float
    y1: float
    x2: float
    y2: float

    @property
    def length(self) -> float:
        return abs(self.x2 - self.x1) + abs(self.y2 - self.y1)

    @property
    def solid(self) -> Rectangle:
        """The rectangle it occupies."""
        half = THICKNESS / 2.0
        return Rectangle(
            self.x1 - half, self.y1 - half, self.x2 - self.x1 + THICKNESS, self.y2 - self.y1 + THICKNESS
        )


class FloorPlan(NamedTuple):
    """Rooms of one floor.

    Attributes:
        rooms: Rooms.
        walls: Walls, including the outer ones.
        doorways: Gaps between walls.
    """

    rooms: List[Rectangle]
    walls: List[WallSegment]
    doorways: List[WallSegment]

    @property
    def solids(self) -> List[Rectangle]:
        """The rectangles occupied by its walls."""
        return [wall.solid for wall in self.walls]

    def add_with_door(self, wall: WallSegment, rng: np.random.Generator) -> None:
        """Add a wall with a door at a random position."""
        doorway, *pieces = _with_door(wall, rng)
        self.doorways.append(doorway)
        self.walls.extend(pieces)


def outer_walls(room: Rectangle) -> List[WallSegment]:
    """Return walls along the four sides of a rectangle."""
    x, y, right, top = room.corners
    return [
        WallSegment(x, y, right, y),
        WallSegment(x, top, right, top),
        WallSegment(x, y, x, top),
        WallSegment(right, y, right, top),
    ]


def generate_floor_plan(outline: Rectangle, rng: np.random.Generator) -> FloorPlan:
    """Generate a floor plan by splitting the outline recursively."""
    floor = FloorPlan([], outer_walls(outline), [])
    pending = [outline]
    while pending:
        room = pending.pop()
        split = _split(room, rng) if _is_split(room, rng) else None
        if split is None or any(_blocks(split[2], door) for door in floor.doorways):
            floor.rooms.append(room)
            continue
        pending += split[:2]
        floor.add_with_door(split[2], rng)
    return floor


def _blocks(wall: WallSegment, door: WallSegment) -> bool:
    """Whether a wall would end in a door, or too close to it."""
    return any(
        door.x1 - DOOR_MARGIN <= x <= door.x2 + DOOR_MARGIN
        and door.y1 - DOOR_MARGIN <= y <= door.y2 + DOOR_MARGIN
        for x, y in ((wall.x1, wall.y1), (wall.x2, wall.y2))
    )


def _is_split(room: Rectangle, rng: np.random.Generator) -> bool:
    if max(room.width, room.depth) < 2 * SMALLEST_SIDE:
        return False
    share = (room.area - MIN_SPLIT_AREA) / (MAX_ROOM_AREA - MIN_SPLIT_AREA)
    return bool(rng.random() < share)


def _split(room: Rectangle, rng: np.random.Generator) -> Tuple[Rectangle, Rectangle, WallSegment]:
    """Split a room across its longer side."""
    longer = max(room.width, room.depth)
    at = rng.uniform(max(SMALLEST_SIDE, 0.35 * longer), min(longer - SMALLEST_SIDE, 0.65 * longer))
    if room.width >= room.depth:
        x = room.x + at
        return (
            Rectangle(room.x, room.y, at, room.depth),
            Rectangle(x, room.y, room.width - at, room.depth),
            WallSegment(x, room.y, x, room.y + room.depth),
        )
    y = room.y + at
    return (
        Rectangle(room.x, room.y, room.width, at),
        Rectangle(room.x, y, room.width, room.depth - at),
        WallSegment(room.x, y, room.x + room.width, y),
    )


def _with_door(wall: WallSegment, rng: np.random.Generator) -> List[WallSegment]:
    """The doorway, and the two parts of the wall beside it."""
    start = rng.uniform(DOOR_MARGIN, wall.length - DOOR_MARGIN - DOOR_WIDTH)
    along = np.array([wall.x2 - wall.x1, wall.y2 - wall.y1]) / wall.length
    (x1, y1), (x2, y2) = ((wall.x1, wall.y1) + along * at for at in (start, start + DOOR_WIDTH))
    return [
        WallSegment(x1, y1, x2, y2),
        WallSegment(wall.x1, wall.y1, x1, y1),
        WallSegment(x2, y2, wall.x2, wall.y2),
    ]
