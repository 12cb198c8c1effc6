"""Furniture put into a floor plan piece by piece, so that nothing is cut off by it."""

from dataclasses import dataclass
from typing import Callable, List, Sequence, Tuple

import numpy as np

from laboratory.generators.raster import RESOLUTION, Raster
from laboratory.generators.rooms import THICKNESS, Room
from laboratory.tasks.ways import ROOM_TO_PASS

# Metres from a robot's middle to what is solid where it stands.
ROOM_TO_STAND = 0.55
# Half of what the raster takes for wide enough to pass: it tells distances up to a cell too large.
WAY = ROOM_TO_PASS + RESOLUTION
# How often a place is looked for, for each piece.
TRIES = 4


class Furniture:
    """The ``pieces`` that stand between ``solids``; ``start``: where the robot begins and needs room."""

    def __init__(self, outline: Room, solids: Sequence[Room], start: Tuple[float, float]):
        self.pieces: List[Room] = []
        self._start = start
        self._raster = Raster(outline.width, outline.depth)
        for solid in solids:
            self._raster.fill(*solid.corners)
        self._reach = self._raster.within_reach(*start, WAY)

    def put(self, piece: Room) -> bool:
        """Puts it there, and tells whether; not where the robot starts, nor where it cuts anything off."""
        if piece.distance_to(*self._start) < ROOM_TO_STAND + 2.0 * RESOLUTION:
            return False
        tried, around = self._raster.copy(), self._raster.copy()
        x1, y1, x2, y2 = piece.corners
        tried.fill(x1, y1, x2, y2)
        around.fill(x1 - WAY, y1 - WAY, x2 + WAY, y2 + WAY)
        left = tried.within_reach(*self._start, WAY)
        # Its own place and what is too near to it are lost; more would be a corner that is cut off.
        if not left.any() or (self._reach & ~left & ~around.solid).any():
            return False
        self.pieces.append(piece)
        self._raster, self._reach = tried, left
        return True

    def fill(self, room: Room, area_of_a_piece: float, drawn: Callable[[Room], Room]) -> None:
        """Puts pieces into a room, each as ``drawn`` for it, one for so many square metres if they fit."""
        wanted = int(room.area / area_of_a_piece)
        for _ in range(TRIES * wanted):
            if wanted:
                wanted -= self.put(drawn(room))


@dataclass(frozen=True)
class Style:
    """Least and greatest length of either side of a piece, metres; shares that stand at walls along x, y."""

    widths: Tuple[float, float]
    depths: Tuple[float, float]
    along_x: float = 0.4
    along_y: float = 0.4

    def piece(self, room: Room, rng: np.random.Generator) -> Room:
        """One in a room, no side longer than half of the room's."""
        sides = zip((self.widths, self.depths), (room.width, room.depth))
        width, depth = (float(rng.uniform(least, min(most, side / 2.0))) for (least, most), side in sides)
        gap = THICKNESS / 2.0
        x = float(rng.uniform(room.x + gap, room.x + room.width - width - gap))
        y = float(rng.uniform(room.y + gap, room.y + room.depth - depth - gap))
        kind = rng.random()
        if kind < self.along_x:
            y = float(rng.choice([room.y + gap, room.y + room.depth - depth - gap]))
        elif kind < self.along_x + self.along_y:
            x = float(rng.choice([room.x + gap, room.x + room.width - width - gap]))
        return Room(x, y, width, depth)
