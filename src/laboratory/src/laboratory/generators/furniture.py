"""Placement of furniture that keeps all free space reachable."""

from dataclasses import dataclass
from typing import Callable, List, Sequence, Tuple

import numpy as np

from laboratory.generators.floor_plan import THICKNESS, Rectangle
from laboratory.generators.raster import RESOLUTION, Raster
from laboratory.tasks.shortest_paths import PASSAGE_CLEARANCE

# Distance from the centre of a standing robot to obstacles [m].
STANDING_CLEARANCE = 0.55
# Half of the passage width in the raster, whose distances are up to one cell too large [m].
PASSAGE_RADIUS = PASSAGE_CLEARANCE + RESOLUTION
# Positions tried for each piece.
MAX_ATTEMPTS = 4


class Furniture:
    """Furniture of a building.

    Args:
        outline: Outline of the building.
        solids: Rectangles that are occupied by walls.
        start: Start position of the robot, which stays free.

    Attributes:
        pieces: Rectangles of the placed furniture.
    """

    def __init__(self, outline: Rectangle, solids: Sequence[Rectangle], start: Tuple[float, float]):
        self.pieces: List[Rectangle] = []
        self._start = start
        self._raster = Raster(outline.width, outline.depth)
        for solid in solids:
            self._raster.fill(*solid.corners)
        self._reachable = self._raster.reachable_from(*start, PASSAGE_RADIUS)

    def place(self, piece: Rectangle) -> bool:
        """Place a piece unless it blocks the start or cuts off free space; return whether it was placed."""
        if piece.distance_to(*self._start) < STANDING_CLEARANCE + 2.0 * RESOLUTION:
            return False
        candidate, blocked = self._raster.copy(), self._raster.copy()
        x1, y1, x2, y2 = piece.corners
        candidate.fill(x1, y1, x2, y2)
        blocked.fill(x1 - PASSAGE_RADIUS, y1 - PASSAGE_RADIUS, x2 + PASSAGE_RADIUS, y2 + PASSAGE_RADIUS)
        still_reachable = candidate.reachable_from(*self._start, PASSAGE_RADIUS)
        # Only the piece and the margin around it may become unreachable.
        if not still_reachable.any() or (self._reachable & ~still_reachable & ~blocked.solid).any():
            return False
        self.pieces.append(piece)
        self._raster, self._reachable = candidate, still_reachable
        return True

    def fill(
        self, room: Rectangle, area_of_a_piece: float, draw_piece: Callable[[Rectangle], Rectangle]
    ) -> None:
        """Try to place one piece for every ``area_of_a_piece`` square metres of a room."""
        remaining = int(room.area / area_of_a_piece)
        for _ in range(MAX_ATTEMPTS * remaining):
            if remaining:
                remaining -= self.place(draw_piece(room))


@dataclass(frozen=True)
class FurnitureStyle:
    """Random size and position of a kind of furniture.

    Attributes:
        widths: Minimum and maximum extent in x [m].
        depths: Minimum and maximum extent in y [m].
        along_x: Share of pieces that stand at a wall along x.
        along_y: Share of pieces that stand at a wall along y.
    """

    widths: Tuple[float, float]
    depths: Tuple[float, float]
    along_x: float = 0.4
    along_y: float = 0.4

    def piece(self, room: Rectangle, rng: np.random.Generator) -> Rectangle:
        """Draw a piece in a room, no side longer than half of the room's."""
        sides = zip((self.widths, self.depths), (room.width, room.depth))
        width, depth = (float(rng.uniform(low, min(high, side / 2.0))) for (low, high), side in sides)
        gap = THICKNESS / 2.0
        x = float(rng.uniform(room.x + gap, room.x + room.width - width - gap))
        y = float(rng.uniform(room.y + gap, room.y + room.depth - depth - gap))
        kind = rng.random()
        if kind < self.along_x:
            y = float(rng.choice([room.y + gap, room.y + room.depth - depth - gap]))
        elif kind < self.along_x + self.along_y:
            x = float(rng.choice([room.x + gap, room.x + room.width - width - gap]))
        return Rectangle(x, y, width, depth)
