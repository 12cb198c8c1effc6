"""What the turtles draw: the floor as turtlesim's window shows it, and the strokes on it."""

import io
import math
from dataclasses import dataclass, field, replace
from typing import Iterable, List, Tuple, cast

from PIL import Image, ImageDraw

Color = Tuple[int, int, int]
Point = Tuple[float, float]

# turtlesim's window and the height of its turtle, which is a metre, in pixels.
PIXELS, PIXELS_PER_METRE = 500, 45
# The side of the floor, metres.
FLOOR_SIDE = (PIXELS - 1) / PIXELS_PER_METRE
BACKGROUND: Color = (0x45, 0x56, 0xFF)
_TURTLE_COLOR: Color = (0x2E, 0x2E, 0x2E)


@dataclass(frozen=True)
class Pen:
    """``width`` in pixels."""

    color: Color = (0xB3, 0xB8, 0xFF)
    width: int = 3
    is_on: bool = True


@dataclass
class Stroke:
    """A line drawn without lifting the pen; ``points``: its corners, metres, x to the right, y up."""

    turtle: str
    pen: Pen
    points: List[Point] = field(default_factory=list)
    _heading: float = 0.0

    def extend(self, end: Point) -> None:
        """Goes on to ``end``: one that lies in a strip of a pixel along the last part lengthens that.

        (The strip of Reumann and Witkam, 1974, so that a line has no more corners than can be seen.)
        """
        if len(self.points) > 1 and self._is_collinear(end):
            self.points[-1] = end
        else:
            x, y = self.points[-1]
            self._heading = math.atan2(end[1] - y, end[0] - x)
            self.points.append(end)

    def _is_collinear(self, end: Point) -> bool:
        (before, _), (now, aside) = self._from_corner(self.points[-1]), self._from_corner(end)
        return now >= before and abs(aside) <= 0.5 / PIXELS_PER_METRE

    def _from_corner(self, point: Point) -> Point:
        """Metres along the last part, and beside it."""
        x, y = point[0] - self.points[-2][0], point[1] - self.points[-2][1]
        c, s = math.cos(self._heading), math.sin(self._heading)
        return c * x + s * y, c * y - s * x


class Canvas:
    """The floor, of the color ``background``; ``strokes`` are all lines on it, older ones first."""

    def __init__(self, background: Color = BACKGROUND):
        self.clear(background)

    def clear(self, background: Color) -> None:
        """Wipes everything."""
        self.background = background
        self.strokes: List[Stroke] = []
        self._image = Image.new("RGB", (PIXELS, PIXELS), background)
        self._draw = ImageDraw.Draw(self._image)

    def draw(self, turtle: str, pen: Pen, start: Point, end: Point) -> None:
        """Draws a line; one that goes on where the turtle's last one ended lengthens that."""
        self._draw.line((*_pixel(*start), *_pixel(*end)), pen.color, pen.width)
        last = next((stroke for stroke in reversed(self.strokes) if stroke.turtle == turtle), None)
        if last is None or last.pen != pen or last.points[-1] != start:
            last = Stroke(turtle, pen, [start])
            self.strokes.append(last)
        last.extend(end)

    def latest_strokes(self, max_points: int) -> List[Stroke]:
        """Those drawn last, that have so many points together; of the oldest of them its end."""
        shown: List[Stroke] = []
        for stroke in reversed(self.strokes):
            if max_points < 2:
                break
            shown.append(replace(stroke, points=stroke.points[-max_points:]))
            max_points -= len(shown[-1].points)
        return shown[::-1]

    def color_at(self, x: float, y: float) -> Color:
        """The colour under a place, metres."""
        col, row = _pixel(x, y)
        return cast(Color, self._image.getpixel((round(col), round(row))))

    def picture(self, poses: Iterable[Tuple[float, float, float]]) -> bytes:
        """A PNG of the floor with turtles at these poses: x, y, theta."""
        image = self._image.copy()
        draw, radius = ImageDraw.Draw(image), 0.4 * PIXELS_PER_METRE
        for x, y, theta in poses:
            col, row = _pixel(x, y)
            nose = (col + radius * math.cos(theta), row - radius * math.sin(theta))
            draw.ellipse((col - radius, row - radius, col + radius, row + radius), _TURTLE_COLOR)
            draw.line((col, row, *nose), (255, 255, 255), 3)
        buffer = io.BytesIO()
        image.save(buffer, "PNG")
        return buffer.getvalue()


def _pixel(x: float, y: float) -> Tuple[float, float]:
    """Column and row of a place in metres."""
    return x * PIXELS_PER_METRE, (FLOOR_SIDE - y) * PIXELS_PER_METRE
