"""Straight walls in a picture of solid cells: strips along the directions that most of them have."""

import math
from dataclasses import dataclass
from typing import Iterator, List, Tuple

import numpy as np
from scipy.ndimage import affine_transform, binary_closing, binary_opening, find_objects, label

from home_builder.plan.model import Wall

# Shortest wall, thickest wall, and gap that a run of cells is continued over [m].
MIN_LENGTH, MAX_THICKNESS, RUN_GAP = 0.4, 0.45, 0.12
# Directions that are tried one after the other, the step between two [deg], number of projected points.
MOST_DIRECTIONS, STEP, MOST_POINTS = 6, 0.5, 20_000
# Share of the cells that are in no wall yet which a further direction must promise.
WORTHWHILE = 0.02


@dataclass(frozen=True, eq=False)
class SolidCells:
    """Solid cells.

    Attributes:
        cells: Which cells are solid, bool (rows, cols); row 0 has the lowest y.
        resolution: Size of a cell [m].
        corner: Position of the lower left corner [m].
    """

    cells: np.ndarray
    resolution: float
    corner: Tuple[float, float] = (0.0, 0.0)

    @property
    def points_xy(self) -> np.ndarray:
        """Centres of the solid cells, (N, 2) [m]."""
        return (np.argwhere(self.cells)[:, ::-1] + 0.5) * self.resolution + self.corner


def straight_walls(solid: SolidCells) -> Tuple[List[Wall], np.ndarray]:
    """Find straight walls.

    Args:
        solid: Solid cells.

    Returns:
        The walls, and the solid cells that are in none of them, bool (rows, cols).
    """
    rest = solid.cells & ~_thick(solid)
    bulk, walls = solid.cells & ~rest, []
    for _ in range(MOST_DIRECTIONS):
        remaining = SolidCells(rest, solid.resolution, solid.corner)
        before = int(rest.sum())
        if before == 0:
            break
        yaw = main_direction(remaining)
        for turn in (yaw, yaw + math.pi / 2.0):
            found = list(_strips(SolidCells(rest, solid.resolution, solid.corner), turn))
            walls += found
            rest = rest & ~_covered(solid, found)
        if before - int(rest.sum()) < WORTHWHILE * before:
            break
    return walls, rest | (bulk & ~_covered(solid, walls))


def _thick(solid: SolidCells) -> np.ndarray:
    """Return the cells of what is thicker than a wall in both directions, bool (rows, cols)."""
    side = int(math.ceil(MAX_THICKNESS / solid.resolution)) + 1
    return binary_opening(solid.cells, np.ones((side, side), dtype=bool))


def main_direction(solid: SolidCells) -> float:
    """Return the direction in which cells lie in lines, 0 to pi/2 [rad].

    The one, and the one across, whose projections of the cells are most concentrated.
    """
    points_xy = solid.points_xy
    if len(points_xy) > MOST_POINTS:
        points_xy = points_xy[:: len(points_xy) // MOST_POINTS + 1]
    coarse = np.arange(0.0, 90.0, STEP)
    best = coarse[np.argmax([_concentration(points_xy, yaw, solid.resolution) for yaw in coarse])]
    fine = best + np.arange(-STEP, STEP + 1e-9, STEP / 5.0)
    scores = [_concentration(points_xy, yaw, solid.resolution) for yaw in fine]
    # An axis of the grid is preferred to a direction that is hardly better.
    if abs(best) < 1.0 and max(scores) < 1.02 * _concentration(points_xy, 0.0, solid.resolution):
        return 0.0
    return math.radians(float(fine[int(np.argmax(scores))]))


def _concentration(points_xy: np.ndarray, degrees: float, bin_size: float) -> float:
    """Return the sum of the squared counts of points by their distance from an axis and from that across."""
    yaw = math.radians(degrees)
    score = 0.0
    for axis in ((math.cos(yaw), math.sin(yaw)), (-math.sin(yaw), math.cos(yaw))):
        # Off the edges of the bins, which centres of cells would fall on by turns.
        offsets = points_xy @ axis / bin_size
        counts = np.bincount(np.floor(offsets - offsets.min() + 0.25).astype(int)).astype(float)
        score += float((counts**2).sum())
    return score


def _strips(solid: SolidCells, yaw: float) -> Iterator[Wall]:
    """Yield the walls along a direction, from the cells turned by it."""
    turned, middle = _turned(solid, yaw)
    runs = _along_rows(turned, solid.resolution)
    labels, _ = label(runs)
    cos, sin = math.cos(yaw), math.sin(yaw)
    for number, window in enumerate(find_objects(labels), 1):
        part = labels[window] == number
        for first_row, last_row, first_col, last_col in _rectangles(part, solid.resolution):
            row = window[0].start + (first_row + last_row) / 2.0
            ends = []
            for col in (window[1].start + first_col, window[1].start + last_col):
                u = (col - turned.shape[1] / 2.0) * solid.resolution
                v = (row - turned.shape[0] / 2.0) * solid.resolution
                ends.append((float(middle[0] + u * cos - v * sin), float(middle[1] + u * sin + v * cos)))
            yield Wall(ends[0], ends[1], (last_row - first_row) * solid.resolution)


def _turned(solid: SolidCells, yaw: float) -> Tuple[np.ndarray, np.ndarray]:
    """Return the cells in a frame turned by ``yaw`` about the middle, and the middle (2,) [m]."""
    rows, cols = solid.cells.shape
    middle = np.array([cols, rows]) / 2.0 * solid.resolution + solid.corner
    quarters = yaw / (math.pi / 2.0)
    if abs(quarters - round(quarters)) < 1e-9:
        return np.rot90(solid.cells, int(round(quarters))), middle
    side = int(math.ceil(math.hypot(rows, cols))) + 2
    cos, sin = math.cos(yaw), math.sin(yaw)
    matrix = np.array([[cos, sin], [-sin, cos]])  # of (row, col) in the turned frame
    offset = np.array([rows - 1, cols - 1]) / 2.0 - matrix @ ((np.array([side, side]) - 1) / 2.0)
    turned = affine_transform(
        solid.cells.astype(np.float32), matrix, offset, (side, side), order=1, prefilter=False
    )
    return turned > 0.4, middle


def _along_rows(cells: np.ndarray, resolution: float) -> np.ndarray:
    """Return the cells that are in a run along a row as long as a wall, bool (rows, cols)."""
    gap, length = (max(1, int(round(each / resolution))) for each in (RUN_GAP, MIN_LENGTH))
    padded = np.pad(cells, ((0, 0), (gap, gap)))
    closed = binary_closing(padded, np.ones((1, gap + 1), dtype=bool))[:, gap:-gap]
    return binary_opening(closed, np.ones((1, length), dtype=bool))


def _rectangles(part: np.ndarray, resolution: float) -> Iterator[Tuple[int, int, int, int]]:
    """Yield rectangles that cover most of a connected part: first and last row, first and last column.

    Each is the longest range of columns whose upper and lower ends are within a cell of the usual ones.
    """
    part, shortest = part.copy(), max(2, int(round(MIN_LENGTH / resolution)))
    while part.any(axis=0).sum() >= shortest:
        used = part.any(axis=0)
        low = np.argmax(part, axis=0)
        ends = part & ~np.vstack((part[1:], np.zeros((1, part.shape[1]), dtype=bool)))
        high = np.argmax(ends & (np.arange(len(part))[:, None] >= low), axis=0) + 1
        pairs, counts = np.unique(np.column_stack((low, high))[used], axis=0, return_counts=True)
        usual_low, usual_high = pairs[np.argmax(counts)].tolist()
        fits = used & (abs(low - usual_low) <= 1) & (abs(high - usual_high) <= 1)
        first, last = _longest_run(fits, int(round(RUN_GAP / resolution)))
        if last - first >= shortest:
            yield usual_low, usual_high, first, last
        cleared = slice(max(0, usual_low - 1), usual_high + 1)
        part[cleared, first:last] = False
        if last - first < 1:
            return


def _longest_run(flags: np.ndarray, gap: int) -> Tuple[int, int]:
    """Return first and last + 1 of the longest run of flags, with up to ``gap`` missing in a row."""
    chosen = np.flatnonzero(flags)
    if not len(chosen):
        return 0, 0
    pieces = np.split(chosen, np.flatnonzero(np.diff(chosen) > gap + 1) + 1)
    longest = max(pieces, key=len)
    return int(longest[0]), int(longest[-1]) + 1


def _covered(solid: SolidCells, walls: List[Wall]) -> np.ndarray:
    """Return the cells within one cell of a wall, bool (rows, cols)."""
    covered = np.zeros(solid.cells.shape, dtype=bool)
    for wall in walls:
        _cover(covered, solid, wall)
    return covered


def _cover(covered: np.ndarray, solid: SolidCells, wall: Wall) -> None:
    cos, sin = math.cos(wall.yaw), math.sin(wall.yaw)
    half = wall.thickness / 2.0 + solid.resolution
    ends = (np.array([wall.start, wall.end]) - solid.corner) / solid.resolution
    reach = half / solid.resolution + 1.0
    low = np.maximum(np.floor(ends.min(axis=0) - reach).astype(int), 0)
    high = np.ceil(ends.max(axis=0) + reach).astype(int)
    rows, cols = covered[low[1] : high[1], low[0] : high[0]].shape
    col, row = np.meshgrid(np.arange(cols) + low[0] + 0.5, np.arange(rows) + low[1] + 0.5)
    x = col * solid.resolution + solid.corner[0] - wall.start[0]
    y = row * solid.resolution + solid.corner[1] - wall.start[1]
    along, across = x * cos + y * sin, y * cos - x * sin
    is_near = (abs(across) <= half) & (along >= -solid.resolution) & (along <= wall.length + solid.resolution)
    covered[low[1] : high[1], low[0] : high[0]] |= is_near
