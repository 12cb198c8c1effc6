"""The floor as turtlesim's window shows it, and the strokes that the turtles draw."""

import io
import math
from dataclasses import dataclass, field, replace
from typing import Iterable, List, Tuple, cast

from PIL import Image, ImageDraw

Color = Tuple[int, int, int]
Point = Tuple[float, float]

# Side of turtlesim's window, and height of its turtle, which is one metre [pixels].
PIXELS, PIXELS_PER_METRE = 500, 45
# Side of the floor [m].
FLOOR_SIDE = (PIXELS - 1) / PIXELS_PER_METRE
BACKGROUND: Color = (0x45, 0x56, 0xFF)
_TURTLE_COLOR: Color = (0x2E, 0x2E, 0x2E)


@dataclass(frozen=True)
class Pen:
    """Pen of a turtle; ``width`` in pixels."""

    color: Color = (0xB3, 0xB8, 0xFF)
    width: int = 3
    is_on: bool = True


@dataclass
class Stroke:
    """A line drawn without lifting the pen.

    Attributes:
        turtle: Name of the turtle.
        pen: The pen.
        points: Corners x, y [m].
    """

    turtle: str
    pen: Pen
    points: List[Point] = field(default_factory=list)
    _heading: float = 0.0

    def extend(self, end: Point) -> None:
        """Extend the line to ``end``; within a strip of one pixel the last segment is lengthened instead.

        Line simplification by Reumann and Witkam (1974): no more corners than are visible.
        """
        if len(self.points) > 1 and self._is_collinear(end):
            self.points[-1] = end
        else:
            x, y = self.points[-1]
            self._heading = math.atan2(end[1] - y, end[0] - x)
            self.points.append(end)

    def _is_collinear(self, end: Point) -> bool:
        (before, _), (now, lateral) = self._from_corner(self.points[-1]), self._from_corner(end)
        return now >= before and abs(lateral) <= 0.5 / PIXELS_PER_METRE

    def _from_corner(self, point: Point) -> Point:
        """Longitudinal and lateral distance from the last corner along the last segment [m]."""
        x, y = point[0] - self.points[-2][0], point[1] - self.points[-2][1]
        c, s = math.cos(self._heading), math.sin(self._heading)
        return c * x + s * y, c * y - s * x


class Canvas:
    """The floor with its background colour and strokes, in the order of drawing."""

    def __init__(self, background: Color = BACKGROUND):
        self.clear(background)

    def clear(self, background: Color) -> None:
        """Remove all strokes and set the background colour."""
        self.background = background
        self.strokes: List[Stroke] = []
        self._image = Image.new("RGB", (PIXELS, PIXELS), background)
        self._draw = ImageDraw.Draw(self._image)

    def draw(self, turtle: str, pen: Pen, start: Point, end: Point) -> None:
        """Draw a line [m]; extends the turtle's last stroke if it starts at its end."""
        self._draw.line((*_pixel(*start), *_pixel(*end)), pen.color, pen.width)
        last = next((stroke for stroke in reversed(self.strokes) if stroke.turtle == turtle), None)
        if last is None or last.pen != pen or last.points[-1] != start:
            last = Stroke(turtle, pen, [start])
            self.strokes.append(last)
        last.extend(end)

    def latest_strokes(self, max_points: int) -> List[Stroke]:
        """The latest strokes with ``max_points`` points in total; the oldest of them is truncated."""
        shown: List[Stroke] = []
        for stroke in reversed(self.strokes):
            if max_points < 2:
                break
            shown.append(replace(stroke, points=stroke.points[-max_points:]))
            max_points -= len(shown[-1].points)
        return shown[::-1]

    def color_at(self, x: float, y: float) -> Color:
        """Colour of the floor at a position [m]."""
        col, row = _pixel(x, y)
        return cast(Color, self._image.getpixel((round(col), round(row))))

    def picture(self, poses: Iterable[Tuple[float, float, float]]) -> bytes:
        """Render the floor with turtles at poses x, y, theta [m, rad]; returns a PNG."""
        image = self._image.copy()
        draw, radius = ImageDraw.Draw(image), 0.4 * PIXELS_PER_METRE
        for x, y, theta in poses:
            col, row = _pixel(x, y)
            tip = (col + radius * math.cos(theta), row - radius * math.sin(theta))
            draw.ellipse((col - radius, row - radius, col + radius, row + radius), _TURTLE_COLOR)
            draw.line((col, row, *tip), (255, 255, 255), 3)
        buffer = io.BytesIO()
        image.save(buffer, "PNG")
        return buffer.getvalue()


def _pixel(x: float, y: float) -> Tuple[float, float]:
    """Column and row of a position [m]."""
    return x * PIXELS_PER_METRE, (FLOOR_SIDE - y) * PIXELS_PER_METRE
