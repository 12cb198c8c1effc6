"""Picture and animation of a run, drawn with Pillow."""

import math
from typing import Any, Iterator, List, Mapping, Sequence, Tuple

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from planar import OccupancyGrid, Pose2
from run_report.grid_image import grid_image, view_of
from run_report.map_view import thinned
from run_report.record import MarkerEvent, RunRecord

Colour = Tuple[int, int, int, int]
PAPER, INK, FAINT = (255, 255, 255, 255), (29, 35, 48, 255), (102, 112, 133, 255)
WALL, UNKNOWN = (38, 42, 51, 255), (222, 225, 231, 255)
TRUTH, ESTIMATE, ODOMETRY = (37, 99, 235, 255), (232, 89, 12, 255), (152, 162, 179, 255)
ZONE, OBJECT, GOAL = (124, 58, 237, 255), (217, 119, 6, 255), (193, 21, 116, 255)
SIGHT = (37, 99, 235, 40)
COLOURS = (WALL, UNKNOWN, TRUTH, ESTIMATE, ZONE, OBJECT, GOAL)
SUPERSAMPLING = 2  # for smooth edges
ROBOT_RADIUS = 0.18
SIGHT_RANGE = 6.0
BEAMS = 180


class MapCanvas:
    """A map to draw on in metres.

    Args:
        grid: The map.
        points_xy: (N, 2), further points that must be visible.
        width: Width of the shown picture [px].
        header: Height of the header [px].
    """

    def __init__(self, grid: OccupancyGrid, points_xy: np.ndarray, width: int, header: int):
        x_min, y_min, x_max, y_max = view_of(grid, points_xy)
        self._scale = SUPERSAMPLING * width / (x_max - x_min)
        self._x_min, self._y_max, self._top = x_min, y_max, SUPERSAMPLING * header
        self._width = width
        size = (SUPERSAMPLING * width, self._top + round((y_max - y_min) * self._scale))
        self.image = Image.new("RGBA", size, PAPER)
        self._paste(grid)

    def copy(self) -> "MapCanvas":
        """Return a canvas with the same content."""
        clone = object.__new__(MapCanvas)
        clone.__dict__.update(self.__dict__)
        clone.image = self.image.copy()
        return clone

    def path(self, points_xy: np.ndarray, colour: Colour, width: float) -> None:
        """Draw a line through points (N, 2); the width is in shown pixels."""
        if len(points_xy) > 1:
            pixels = [tuple(pixel) for pixel in self._pixels(points_xy)]
            ImageDraw.Draw(self.image).line(
                pixels, fill=colour, width=round(width * SUPERSAMPLING), joint="curve"
            )

    def area(self, points_xy: np.ndarray, colour: Colour) -> None:
        """Draw a translucent polygon."""
        layer = Image.new("RGBA", self.image.size)
        ImageDraw.Draw(layer).polygon([tuple(pixel) for pixel in self._pixels(points_xy)], fill=colour)
        self.image.alpha_composite(layer)

    def disc(self, x: float, y: float, radius: float, fill=None, outline=None) -> None:
        """Draw a disc; the radius is in metres."""
        (u, v), reach = self._pixels(np.array([[x, y]]))[0], radius * self._scale
        box = (u - reach, v - reach, u + reach, v + reach)
        ImageDraw.Draw(self.image).ellipse(box, fill=fill, outline=outline, width=2 * SUPERSAMPLING)

    def label(self, x: float, y: float, text: str, colour: Colour) -> None:
        """Draw text whose bottom centre is at a point of the map."""
        u, v = self._pixels(np.array([[x, y]]))[0]
        draw = ImageDraw.Draw(self.image)
        draw.text(
            (u, v),
            text,
            fill=colour,
            font=_font(13),
            anchor="mb",
            stroke_width=2 * SUPERSAMPLING,
            stroke_fill=PAPER,
        )

    def write(self, left: float, top: float, text: str, colour: Colour, size: int) -> float:
        """Write text into the header, in shown pixels; return its right edge."""
        draw, font = ImageDraw.Draw(self.image), _font(size)
        draw.text((left * SUPERSAMPLING, top * SUPERSAMPLING), text, fill=colour, font=font)
        return left + draw.textlength(text, font=font) / SUPERSAMPLING

    def shown(self) -> Image.Image:
        """Return the picture in the size in which it is shown."""
        height = round(self.image.height * self._width / self.image.width)
        return self.image.convert("RGB").resize((self._width, height), Image.Resampling.LANCZOS)

    def _pixels(self, points_xy: np.ndarray) -> np.ndarray:
        u = (points_xy[:, 0] - self._x_min) * self._scale
        v = (self._y_max - points_xy[:, 1]) * self._scale + self._top
        return np.column_stack([u, v])

    def _paste(self, grid: OccupancyGrid) -> None:
        cells = grid_image(grid, WALL, PAPER, UNKNOWN)
        corner = np.array([[0.0, grid.rows * grid.resolution]])
        u, v = self._pixels(grid.origin.transform_points(corner))[0]
        step, turn = grid.resolution * self._scale, grid.origin.yaw
        cosine, sine = math.cos(turn) / step, math.sin(turn) / step
        # From pixels of the canvas to cells, as Image.transform wants it.
        to_cells = (cosine, -sine, -cosine * u + sine * v, sine, cosine, -sine * u - cosine * v)
        mapped = cells.transform(self.image.size, Image.Transform.AFFINE, to_cells, Image.Resampling.NEAREST)
        self.image.alpha_composite(mapped)


def run_picture(result: Mapping[str, Any], record: RunRecord, width: int = 900) -> Image.Image:
    """Return the map with all trajectories, the zones and the verdict."""
    canvas = _background(record, width, header=78)
    canvas.path(thinned(record.odometry[:, 1:3]), ODOMETRY, 1.5)
    canvas.path(thinned(record.truth[:, 1:3]), TRUTH, 5.0)
    canvas.path(thinned(record.estimate[:, 1:3]), ESTIMATE, 2.0)
    if len(record.truth):
        _draw_robot(canvas, record.truth[-1])
        _draw_object(canvas, record, record.truth[-1])
    verdict = "success" if result.get("success") else "failure"
    title = f"{result.get('command', 'run')}, seed {result.get('seed', '?')}: {verdict}"
    canvas.write(16, 10, title, INK, 22)
    left = 16.0
    for name, colour, path in (
        ("true", TRUTH, record.truth),
        ("estimated", ESTIMATE, record.estimate),
        ("odometry alone", ODOMETRY, record.odometry),
    ):
        if len(path):
            left = canvas.write(left, 44, name, colour, 16) + 18
    error = result.get("localization_error")
    if error:
        canvas.write(
            left, 44, f"localization off by {error['mean']:.3f} m, at worst {error['max']:.3f} m", FAINT, 16
        )
    return canvas.shown()


def run_frames(
    result: Mapping[str, Any], record: RunRecord, width: int = 560, count: int = 90
) -> Iterator[Image.Image]:
    """Yield the run in ``count`` pictures: robot, field of view of its laser, trajectories so far."""
    if not len(record.truth):
        return
    background = _background(record, width, header=34)
    for row in record.truth[np.linspace(0, len(record.truth) - 1, count).round().astype(int)]:
        canvas, stamp = background.copy(), row[0]
        if record.grid is not None:
            canvas.area(_field_of_view(record.grid, row), SIGHT)
        canvas.path(thinned(_until(record.truth, stamp)[:, 1:3]), TRUTH, 3.5)
        canvas.path(thinned(_until(record.estimate, stamp)[:, 1:3]), ESTIMATE, 1.5)
        _draw_robot(canvas, row)
        _draw_object(canvas, record, row)
        state = next((state.name for state in reversed(record.states) if state.stamp <= stamp), "")
        canvas.write(10, 8, f"{stamp:5.1f} s   {state}", INK, 15)
        yield canvas.shown()


def save_animation(path, frames: Sequence[Image.Image], seconds: float = 9.0) -> None:
    """Write an endless GIF of so many seconds; its last frame is shown longer."""
    palette = _palette(frames)
    reduced = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    durations = [round(1000.0 * seconds / len(frames))] * len(frames)
    durations[-1] = 2000
    reduced[0].save(
        path, "GIF", save_all=True, append_images=reduced[1:], duration=durations, loop=0, optimize=False
    )


def _palette(frames: Sequence[Image.Image]) -> Image.Image:
    """Return colours for all frames: those of some frames, and the pure ones, which few pixels have."""
    some = [frames[0], frames[len(frames) // 2], frames[-1]]
    pure = Image.new("RGB", (len(COLOURS), 1))
    pure.putdata([colour[:3] for colour in COLOURS])
    some.append(pure.resize(some[0].size, Image.Resampling.NEAREST))
    width, height = some[0].size
    sample = Image.new("RGB", (width, height * len(some)))
    for number, picture in enumerate(some):
        sample.paste(picture, (0, number * height))
    return sample.quantize(96, Image.Quantize.MEDIANCUT)


def _background(record: RunRecord, width: int, header: int) -> MapCanvas:
    grid = record.grid or OccupancyGrid(np.full((1, 1), -1, dtype=np.int8), 0.05)
    canvas = MapCanvas(grid, np.concatenate([record.truth[:, 1:3], record.estimate[:, 1:3]]), width, header)
    for zone in record.zones:
        canvas.disc(zone.x, zone.y, zone.radius, fill=(237, 231, 254, 255), outline=ZONE)
        canvas.label(zone.x, zone.y + zone.radius + 0.06, zone.name, ZONE)
    for goal in record.goals:
        canvas.disc(goal.x, goal.y, 0.05, fill=GOAL)
    return canvas


def _draw_robot(canvas: MapCanvas, row: np.ndarray) -> None:
    _, x, y, yaw = row
    canvas.disc(x, y, ROBOT_RADIUS, fill=TRUTH, outline=PAPER)
    tip = np.array([[x, y], [x + ROBOT_RADIUS * math.cos(yaw), y + ROBOT_RADIUS * math.sin(yaw)]])
    canvas.path(tip, PAPER, 2.5)


def _draw_object(canvas: MapCanvas, record: RunRecord, row: np.ndarray) -> None:
    for marking in _markers_at(record, float(row[0])):
        if marking.is_shown:
            corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * 0.11
            canvas.area(corners + [marking.x, marking.y], OBJECT)


def _markers_at(record: RunRecord, stamp: float) -> List[MarkerEvent]:
    """Return the latest state of each marker."""
    latest = {marking.name: marking for marking in record.markings if marking.stamp <= stamp}
    return list(latest.values())


def _field_of_view(grid: OccupancyGrid, row: np.ndarray) -> np.ndarray:
    from planar.geometry.ray_casting import cast_rays  # late: imports numba

    pose = Pose2.from_array(row[1:])
    angles = np.linspace(-math.pi, math.pi, BEAMS, endpoint=False)
    ranges = cast_rays(grid, pose, angles, SIGHT_RANGE)
    return pose.transform_points(np.column_stack([ranges * np.cos(angles), ranges * np.sin(angles)]))


def _until(rows: np.ndarray, stamp: float) -> np.ndarray:
    return rows[: np.searchsorted(rows[:, 0], stamp, side="right")]


def _font(size: int):
    return ImageFont.load_default(size * SUPERSAMPLING)
