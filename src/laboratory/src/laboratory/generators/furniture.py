"""Furniture put into a floor plan piece by piece, so that nothing is cut off by it."""

from dataclasses import dataclass
from typing import Callable, List, Sequence, Tuple

import numpy as np

from laboratory.generators.floor_plan import THICKNESS, Rectangle
from laboratory.generators.raster import RESOLUTION, Raster
from laboratory.tasks.shortest_paths import PASSAGE_CLEARANCE

# Metres from a robot's middle to what is solid where it stands.
STANDING_CLEARANCE = 0.55
# Half of what the raster takes for wide enough to pass: it tells distances up to a cell too large.
PASSAGE_RADIUS = PASSAGE_CLEARANCE + RESOLUTION
# How often a place is looked for, for each piece.
MAX_ATTEMPTS = 4


class Furniture:
    """The ``pieces`` that stand between ``solids``; ``start``: where the robot begins and needs room."""

    def __init__(self, outline: Rectangle, solids: Sequence[Rectangle], start: Tuple[float, float]):
        self.pieces: List[Rectangle] = []
        self._start = start
        self._raster = Raster(outline.width, outline.depth)
        for solid in solids:
            self._raster.fill(*solid.corners)
        self._reachable = self._raster.reachable_from(*start, PASSAGE_RADIUS)

    def place(self, piece: Rectangle) -> bool:
        """Puts it there, and tells whether; not where the robot starts, nor where it cuts anything off."""
        if piece.distance_to(*self._start) < STANDING_CLEARANCE + 2.0 * RESOLUTION:
            return False
        candidate, blocked = self._raster.copy(), self._raster.copy()
        x1, y1, x2, y2 = piece.corners
        candidate.fill(x1, y1, x2, y2)
        blocked.fill(x1 - PASSAGE_RADIUS, y1 - PASSAGE_RADIUS, x2 + PASSAGE_RADIUS, y2 + PASSAGE_RADIUS)
        still_reachable = candidate.reachable_from(*self._start, PASSAGE_RADIUS)
        # Its own place and what is too near to it are lost; more would be a corner that is cut off.
        if not still_reachable.any() or (self._reachable & ~still_reachable & ~blocked.solid).any():
            return False
        self.pieces.append(piece)
        self._raster, self._reachable = candidate, still_reachable
        return True

    def fill(
        self, room: Rectangle, area_of_a_piece: float, draw_piece: Callable[[Rectangle], Rectangle]
    ) -> None:
        """Puts pieces into a room, each as ``drawn`` for it, one for so many square metres if they fit."""
        remaining = int(room.area / area_of_a_piece)
        for _ in range(MAX_ATTEMPTS * remaining):
            if remaining:
                remaining -= self.place(draw_piece(room))


@dataclass(frozen=True)
class FurnitureStyle:
    """Least and greatest length of either side of a piece, metres; shares that stand at walls along x, y."""

    widths: Tuple[float, float]
    depths: Tuple[float, float]
    along_x: float = 0.4
    along_y: float = 0.4

    def piece(self, room: Rectangle, rng: np.random.Generator) -> Rectangle:
        """One in a room, no side longer than half of the room's."""
        sides = zip((self.widths, self.depths), (room.width, room.depth))
        width, depth = (
            float(rng.uniform(min_area, min(most, side / 2.0))) for (min_area, most), side in sides
        )
        gap = THICKNESS / 2.0
        x = float(rng.uniform(room.x + gap, room.x + room.width - width - gap))
        y = float(rng.uniform(room.y + gap, room.y + room.depth - depth - gap))
        kind = rng.random()
        if kind < self.along_x:
            y = float(rng.choice([room.y + gap, room.y + room.depth - depth - gap]))
        elif kind < self.along_x + self.along_y:
            x = float(rng.choice([room.x + gap, room.x + room.width - width - gap]))
        return Rectangle(x, y, width, depth)
