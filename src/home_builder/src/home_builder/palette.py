"""The palette of furniture: each kind as boxes and cylinders, scaled to the size of a piece."""

from dataclasses import dataclass
from typing import Dict, List, Sequence, Tuple

Triple = Tuple[float, float, float]
OUTLINE = "outline"
BOX, CYLINDER = "box", "cylinder"
WOOD, FABRIC, WHITE, GREEN, CLAY, GREY = (
    (0.62, 0.44, 0.27),
    (0.42, 0.47, 0.58),
    (0.93, 0.93, 0.9),
    (0.25, 0.5, 0.25),
    (0.68, 0.4, 0.3),
    (0.6, 0.6, 0.6),
)
OUTLINE_COLOUR = (0.7, 0.66, 0.6)


@dataclass(frozen=True)
class Part:
    """A solid of a piece of furniture; lengths are fractions of the piece's size.

    Attributes:
        shape: ``box`` or ``cylinder``.
        low: Lowest corner, with the middle of the piece at x = y = 0 and the floor at z = 0.
        high: Highest corner.
        colour: Red, green, blue, 0 to 1.
    """

    shape: str
    low: Triple
    high: Triple
    colour: Triple

    def middle(self, size: Triple) -> Triple:
        """Return its middle in a piece of this size [m]."""
        x, y, z = ((a + b) / 2.0 * side for a, b, side in zip(self.low, self.high, size))
        return x, y, z

    def extent(self, size: Triple) -> Triple:
        """Return its extent along the axes in a piece of this size [m]."""
        x, y, z = ((b - a) * side for a, b, side in zip(self.low, self.high, size))
        return x, y, z


@dataclass(frozen=True)
class Kind:
    """A kind of furniture.

    Attributes:
        size: Usual width, depth and height [m].
        parts: Its solids.
    """

    size: Triple
    parts: Sequence[Part]


def _box(x1: float, y1: float, z1: float, x2: float, y2: float, z2: float, colour: Triple) -> Part:
    return Part(BOX, (x1, y1, z1), (x2, y2, z2), colour)


def _legs(side: float, top: float) -> List[Part]:
    """Four legs below a top, at the corners; ``side`` and ``top`` as fractions."""
    corners = [(-0.5, -0.5), (0.5 - side, -0.5), (-0.5, 0.5 - side), (0.5 - side, 0.5 - side)]
    return [_box(x, y, 0.0, x + side, y + side, top, WOOD) for x, y in corners]


_SOLID = (_box(-0.5, -0.5, 0.0, 0.5, 0.5, 1.0, WOOD),)
KINDS: Dict[str, Kind] = {
    "bed": Kind(
        (2.0, 1.6, 0.9),
        (_box(-0.5, -0.5, 0.0, 0.47, 0.5, 0.55, WHITE), _box(0.47, -0.5, 0.0, 0.5, 0.5, 1.0, WOOD)),
    ),
    "table": Kind((1.4, 0.8, 0.75), (_box(-0.5, -0.5, 0.94, 0.5, 0.5, 1.0, WOOD), *_legs(0.07, 0.94))),
    "chair": Kind(
        (0.45, 0.45, 0.9),
        (
            _box(-0.5, -0.5, 0.46, 0.5, 0.5, 0.51, WOOD),
            _box(0.42, -0.5, 0.51, 0.5, 0.5, 1.0, WOOD),
            *_legs(0.1, 0.46),
        ),
    ),
    "shelf": Kind((1.0, 0.35, 1.8), _SOLID),
    "wardrobe": Kind((1.2, 0.6, 2.0), _SOLID),
    "sofa": Kind(
        (2.0, 0.9, 0.8),
        (_box(-0.5, -0.5, 0.0, 0.5, 0.5, 0.55, FABRIC), _box(-0.5, 0.28, 0.55, 0.5, 0.5, 1.0, FABRIC)),
    ),
    "kitchen": Kind(
        (2.4, 0.6, 0.9),
        (_box(-0.5, -0.5, 0.0, 0.5, 0.5, 0.95, WHITE), _box(-0.5, -0.5, 0.95, 0.5, 0.5, 1.0, GREY)),
    ),
    "plant": Kind(
        (0.4, 0.4, 1.1),
        (
            Part(CYLINDER, (-0.5, -0.5, 0.0), (0.5, 0.5, 0.36), CLAY),
            Part(CYLINDER, (-0.4, -0.4, 0.36), (0.4, 0.4, 1.0), GREEN),
        ),
    ),
    "stairs": Kind(
        (2.5, 1.0, 2.4),
        tuple(
            _box(-0.5 + step / 8.0, -0.5, 0.0, -0.375 + step / 8.0, 0.5, (step + 1) / 8.0, GREY)
            for step in range(8)
        ),
    ),
    "box": Kind((0.6, 0.6, 0.6), _SOLID),
}
