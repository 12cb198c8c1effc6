"""A floor plan: a rectangle cut into rooms, each cut a wall with a door, so that all rooms are connected."""

import math
from dataclasses import dataclass
from typing import List, NamedTuple, Tuple

import numpy as np

# Metres: of the least room, of a door, of the wall that stays on either side of it; square metres: of a room
# that is never, and of one that is always cut.
SMALLEST_SIDE, DOOR, BESIDE_DOOR = 2.4, 1.1, 0.5
SMALL_ROOM, LARGE_ROOM = 12.0, 30.0
THICKNESS = 0.12


@dataclass(frozen=True)
class Room:
    """From x, y to x + width, y + depth; metres. Walls and furniture are told so too."""

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
        """x, y of the least, x, y of the greatest."""
        return self.x, self.y, self.x + self.width, self.y + self.depth

    def distance_to(self, x: float, y: float) -> float:
        """Metres from a place; 0 within."""
        off_x = max(self.x - x, x - self.x - self.width, 0.0)
        return math.hypot(off_x, max(self.y - y, y - self.y - self.depth, 0.0))


@dataclass(frozen=True)
class Wall:
    """A straight piece from one end to the other."""

    x1: float
    y1: float
    x2: float
    y2: float

    @property
    def length(self) -> float:
        return abs(self.x2 - self.x1) + abs(self.y2 - self.y1)

    @property
    def solid(self) -> Room:
        """What it takes up."""
        half = THICKNESS / 2.0
        return Room(
            self.x1 - half, self.y1 - half, self.x2 - self.x1 + THICKNESS, self.y2 - self.y1 + THICKNESS
        )


class FloorPlan(NamedTuple):
    """``walls``: those outside among them; ``doorways``: what walls leave open."""

    rooms: List[Room]
    walls: List[Wall]
    doorways: List[Wall]

    @property
    def solids(self) -> List[Room]:
        """What its walls take up."""
        return [wall.solid for wall in self.walls]

    def add_with_door(self, wall: Wall, rng: np.random.Generator) -> None:
        """A wall with a door somewhere in it."""
        doorway, *pieces = _with_door(wall, rng)
        self.doorways.append(doorway)
        self.walls.extend(pieces)


def walls_round(room: Room) -> List[Wall]:
    """Its four sides."""
    x, y, right, top = room.corners
    return [Wall(x, y, right, y), Wall(x, top, right, top), Wall(x, y, x, top), Wall(right, y, right, top)]


def floor_plan(outline: Room, rng: np.random.Generator) -> FloorPlan:
    """A rectangle cut again and again."""
    floor = FloorPlan([], walls_round(outline), [])
    waiting = [outline]
    while waiting:
        room = waiting.pop()
        cut = _cut(room, rng) if _is_cut(room, rng) else None
        if cut is None or any(_ends_in(cut[2], door) for door in floor.doorways):
            floor.rooms.append(room)
            continue
        waiting += cut[:2]
        floor.add_with_door(cut[2], rng)
    return floor


def _ends_in(wall: Wall, door: Wall) -> bool:
    """Whether a wall would end in a door, or too near to it."""
    return any(
        door.x1 - BESIDE_DOOR <= x <= door.x2 + BESIDE_DOOR
        and door.y1 - BESIDE_DOOR <= y <= door.y2 + BESIDE_DOOR
        for x, y in ((wall.x1, wall.y1), (wall.x2, wall.y2))
    )


def _is_cut(room: Room, rng: np.random.Generator) -> bool:
    if max(room.width, room.depth) < 2 * SMALLEST_SIDE:
        return False
    share = (room.area - SMALL_ROOM) / (LARGE_ROOM - SMALL_ROOM)
    return bool(rng.random() < share)


def _cut(room: Room, rng: np.random.Generator) -> Tuple[Room, Room, Wall]:
    """Across its longer side."""
    longer = max(room.width, room.depth)
    at = rng.uniform(max(SMALLEST_SIDE, 0.35 * longer), min(longer - SMALLEST_SIDE, 0.65 * longer))
    if room.width >= room.depth:
        x = room.x + at
        return (
            Room(room.x, room.y, at, room.depth),
            Room(x, room.y, room.width - at, room.depth),
            Wall(x, room.y, x, room.y + room.depth),
        )
    y = room.y + at
    return (
        Room(room.x, room.y, room.width, at),
        Room(room.x, y, room.width, room.depth - at),
        Wall(room.x, y, room.x + room.width, y),
    )


def _with_door(wall: Wall, rng: np.random.Generator) -> List[Wall]:
    """A door, and the two pieces beside it."""
    start = rng.uniform(BESIDE_DOOR, wall.length - BESIDE_DOOR - DOOR)
    along = np.array([wall.x2 - wall.x1, wall.y2 - wall.y1]) / wall.length
    (x1, y1), (x2, y2) = ((wall.x1, wall.y1) + along * at for at in (start, start + DOOR))
    return [Wall(x1, y1, x2, y2), Wall(wall.x1, wall.y1, x1, y1), Wall(x2, y2, wall.x2, wall.y2)]
