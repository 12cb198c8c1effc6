"""Buildings and whole sites, made from a seed, and the ways on which a robot can go through them."""

from dataclasses import dataclass
from typing import Iterator, List, Sequence, Tuple

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2

WALL, CORRIDOR, DOOR = 0.15, 2.2, 0.95
# How far from a building its nearest way passes, metres, and how far from the site's border the outer ways.
YARD, BORDER = 10.0, 6.0
# One tree, and one parked car or bench, for so many square metres of a site; neither stands on a way.
TREE_AREA, CAR_AREA, WAY_WIDTH = 500.0, 900.0, 4.0


@dataclass(frozen=True)
class Building:
    """``columns`` x ``rows`` blocks of rooms, each ``block`` metres (x, y), with corridors around them.

    ``visits``: share of the rooms passed that the robot looks into. ``is_repetitive``: all blocks are alike,
    down to the furniture.
    """

    columns: int
    rows: int
    block: Tuple[float, float]
    room_width: Tuple[float, float]
    visits: float
    is_repetitive: bool = False

    @property
    def pitch(self) -> np.ndarray:
        """From one corridor to the next parallel one, (2,)."""
        return np.array(self.block) + CORRIDOR

    @property
    def size(self) -> np.ndarray:
        """Inside the outer walls, (2,)."""
        return self.pitch * [self.columns, self.rows] + CORRIDOR


class Canvas:
    """Cells to draw what is solid on, from ``corner`` (x, y) on, ``size`` metres (x, y) large."""

    def __init__(self, corner, size, resolution: float, value: int):
        self._corner, self._resolution = np.asarray(corner, dtype=float), resolution
        shape = np.ceil(np.asarray(size) / resolution).astype(int)[::-1]
        self._cells = np.full(shape, value, dtype=np.int8)

    def fill(self, x0: float, y0: float, x1: float, y1: float, value: int = OCCUPIED) -> None:
        """Makes a box solid, or free."""
        edges = (np.array([x0, y0, x1, y1]) - np.tile(self._corner, 2)) / self._resolution
        col, row, end_col, end_row = (max(0, round(edge)) for edge in edges)
        self._cells[row:end_row, col:end_col] = value

    def grid(self) -> OccupancyGrid:
        """What was drawn."""
        return OccupancyGrid(self._cells, self._resolution, Pose2(*self._corner))


class Floor:
    """A building drawn on a canvas with its inner ``corner`` at (x, y).

    ``rooms``: for each the way (3, 2) in from the corridor; ``crossings``: of corridors, by column and row.
    """

    def __init__(self, plan: Building, canvas: Canvas, corner, rng: np.random.Generator):
        self._canvas, self._corner, self._rng = canvas, np.asarray(corner, dtype=float), rng
        self.plan = plan
        width, depth = plan.size
        self._fill(-WALL, -WALL, width + WALL, depth + WALL)
        self._fill(0.0, 0.0, width, depth, FREE)
        self.rooms: List[np.ndarray] = []
        blocks_seed = rng.integers(2**32) if plan.is_repetitive else 0
        for column in range(plan.columns):
            for row in range(plan.rows):
                if plan.is_repetitive:
                    self._rng = np.random.default_rng(blocks_seed)
                self._build_block(CORRIDOR + plan.pitch * [column, row])
        self.crossings = np.array([(i, j) for i in range(plan.columns + 1) for j in range(plan.rows + 1)])

    def crossing_xy(self, crossing) -> np.ndarray:
        """Where two corridors meet."""
        return self._corner + self.plan.pitch * crossing + 0.5 * CORRIDOR

    def rooms_between(self, start: np.ndarray, end: np.ndarray) -> List[np.ndarray]:
        """The ways into the rooms that open to the corridor from ``start`` to ``end``, in this order."""
        low, high = sorted((start[0], end[0]))
        along = [
            way for way in self.rooms if abs(way[0, 1] - start[1]) < 0.1 and abs(start[1] - end[1]) < 0.1
        ]
        passed = [way for way in along if low < way[0, 0] < high]
        return sorted(passed, key=lambda way: abs(way[0, 0] - start[0]))

    def open_to(self, place: np.ndarray) -> None:
        """Breaks a door into the outer wall, between the corridor's end and ``place`` above or below it."""
        x, y = place
        low, high = self._corner[1], self._corner[1] + self.plan.size[1]
        wall = (low - WALL, low) if y < low else (high, high + WALL)
        self._canvas.fill(x - 0.8, wall[0], x + 0.8, wall[1], FREE)

    def _build_block(self, corner: np.ndarray) -> None:
        plan = self.plan
        width, depth = plan.block
        self._fill(*corner, *(corner + plan.block))
        x = 0.0
        while x < width - plan.room_width[0]:
            room = min(self._rng.uniform(*plan.room_width), width - x)
            middle = depth * self._rng.uniform(0.4, 0.6)
            self._build_room(corner + [x, 0.0], room, middle, upwards=True)
            self._build_room(corner + [x, depth], room, depth - middle, upwards=False)
            x += room

    def _build_room(self, corner: np.ndarray, width: float, depth: float, upwards: bool) -> None:
        """A room whose door is in the wall along x through ``corner``, with furniture beside the way in."""
        sign = 1.0 if upwards else -1.0
        self._fill_room(corner, sign, (WALL, WALL, width - WALL, depth - WALL), 0)
        door = self._rng.uniform(0.3, max(width - DOOR - 0.3, 0.31))
        self._fill_room(corner, sign, (door, 0.0, door + DOOR, WALL), 0)
        way_x = door + 0.5 * DOOR
        inside = self._rng.uniform(1.0, max(depth - 1.0, 1.1))
        for _ in range(self._rng.integers(2, 6)):
            x, y = self._rng.uniform(WALL, width - WALL), self._rng.uniform(WALL, depth - WALL)
            size = self._rng.uniform(0.2, 1.2, 2)
            if abs(x - way_x) > 0.5 * size[0] + 0.45 or y - 0.5 * size[1] > inside + 0.5:
                box = (max(x - 0.5 * size[0], 0.0), max(y - 0.5 * size[1], 0.0))
                self._fill_room(
                    corner, sign, (*box, min(x + 0.5 * size[0], width), min(y + 0.5 * size[1], depth))
                )
        way = [(way_x, -0.5 * CORRIDOR), (way_x, 0.0), (way_x, inside)]
        self.rooms.append(self._corner + corner + np.array(way) * [1.0, sign])

    def _fill_room(self, corner: np.ndarray, sign: float, box, value: int = OCCUPIED) -> None:
        x0, y0, x1, y1 = box
        ys = sorted((corner[1] + sign * y0, corner[1] + sign * y1))
        self._fill(corner[0] + x0, ys[0], corner[0] + x1, ys[1], value)

    def _fill(self, x0: float, y0: float, x1: float, y1: float, value: int = OCCUPIED) -> None:
        x, y = self._corner
        self._canvas.fill(x + x0, y + y0, x + x1, y + y1, value)


class House:
    """One building: the true ``grid``, and a walk through its corridors and rooms without end."""

    def __init__(self, plan: Building, rng: np.random.Generator, resolution: float = 0.025):
        canvas = Canvas((-WALL, -WALL), plan.size + 2.0 * WALL, resolution, FREE)
        self._floor = Floor(plan, canvas, (0.0, 0.0), rng)
        self.grid = canvas.grid()

    def walk(self, rng: np.random.Generator) -> Iterator[np.ndarray]:
        """Places (x, y) to go to: along corridors, into rooms on the way, seldom straight back."""
        floor = self._floor
        last, here = None, np.array([0, 0])
        yield floor.crossing_xy(here)
        while True:
            near = floor.crossings[np.abs(floor.crossings - here).sum(axis=1) == 1]
            onward = [crossing for crossing in near if last is None or (crossing != last).any()]
            last, here = here, onward[rng.integers(len(onward))]
            start, end = floor.crossing_xy(last), floor.crossing_xy(here)
            yield from _into_rooms(floor.rooms_between(start, end), floor.plan.visits, rng)
            yield end


class Campus:
    """Buildings in a yard of ``slots`` (columns, rows), ``size`` metres (x, y), with ways, trees and cars.

    A walk leads through one building after the other, over the yard between them, and back to its beginning,
    where it goes on as it began.
    """

    def __init__(self, buildings: Sequence[Building], slots: Tuple[int, int], size, rng: np.random.Generator):
        self._canvas = Canvas((0.0, 0.0), size, 0.05, FREE)
        self._size, self._slots = np.asarray(size, dtype=float), np.asarray(slots)
        self._places: List[np.ndarray] = []
        self._links: List[Tuple[int, int]] = []
        # Of each place, the floor that it is on, or -1; and of each floor, its places.
        self._floor_of: List[int] = []
        self._build_roads()
        self.floors = [self._build(plan, slot, rng) for slot, plan in enumerate(buildings)]
        self._furnish(rng)
        self.grid = self._canvas.grid()
        ends = np.array(self._links)
        lengths = [float(np.hypot(*(self._places[a] - self._places[b]))) for a, b in self._links]
        self._graph = csr_matrix((lengths, tuple(ends.T)), shape=(len(self._places),) * 2)

    def walk(self, rng: np.random.Generator, stops: int = 3, again: int = 4) -> Iterator[np.ndarray]:
        """Places (x, y): ``stops`` crossings in each building, then ``again`` places as at the beginning."""
        tour: List[int] = []
        for number in range(len(self.floors)):
            inside = [place for place, on in enumerate(self._floor_of) if on == number]
            tour += [int(place) for place in rng.choice(inside, stops, replace=False)]
        way = [tour[0]]
        for goal in [*tour[1:], tour[0]]:
            way += self._way(way[-1], goal)[1:]
        way += way[1:again]
        yield self._places[way[0]]
        for last, here in zip(way, way[1:]):
            start, end = self._places[last], self._places[here]
            if self._floor_of[last] == self._floor_of[here] >= 0:
                floor = self.floors[self._floor_of[last]]
                yield from _into_rooms(floor.rooms_between(start, end), floor.plan.visits, rng)
            yield end

    def _way(self, start: int, goal: int) -> List[int]:
        """The shortest way from place to place."""
        _, before = dijkstra(self._graph, directed=False, indices=start, return_predecessors=True)
        way = [goal]
        while way[-1] != start:
            way.append(int(before[way[-1]]))
        return way[::-1]

    def _add(self, place, floor: int = -1) -> int:
        self._places.append(np.asarray(place, dtype=float))
        self._floor_of.append(floor)
        return len(self._places) - 1

    def _road_xy(self, column: int, row: int) -> np.ndarray:
        return BORDER + (self._size - 2.0 * BORDER) * [column, row] / self._slots

    def _build_roads(self) -> None:
        """A lattice of ways around the slots; places are counted row by row."""
        columns, rows = self._slots + 1
        for row in range(rows):
            for column in range(columns):
                here = self._add(self._road_xy(column, row))
                self._links += [(here - 1, here)] if column else []
                self._links += [(here - columns, here)] if row else []

    def _build(self, plan: Building, slot: int, rng: np.random.Generator) -> Floor:
        """Draws a building somewhere in its slot, with a door to the way below and one to the way above."""
        row, column = divmod(slot, int(self._slots[0]))
        low, high = self._road_xy(column, row), self._road_xy(column + 1, row + 1)
        corner = rng.uniform(low + YARD, high - YARD - plan.size)
        floor = Floor(plan, self._canvas, np.round(corner / 0.05) * 0.05, rng)
        first = len(self._places)
        rows = plan.rows + 1
        for i, (x, y) in enumerate(floor.crossings):
            here = self._add(floor.crossing_xy((x, y)), slot)
            self._links += [(here - 1, here)] if y else []
            self._links += [(here - rows, here)] if i >= rows else []
        below, above = first, len(self._places) - 1
        for inside, y, side in ((below, low[1], row), (above, high[1], row + 1)):
            door = self._add((self._places[inside][0], y))
            floor.open_to(self._places[door])
            left = side * (int(self._slots[0]) + 1) + column
            self._links += [(inside, door), (left, door), (door, left + 1)]
        return floor

    def _furnish(self, rng: np.random.Generator) -> None:
        """Trees and cars in the yard, where no way leads and no building stands."""
        cells = self._canvas.grid().cells
        for area, sizes in ((TREE_AREA, ((0.25, 0.6), (0.25, 0.6))), (CAR_AREA, ((1.6, 4.5), (1.6, 4.5)))):
            for _ in range(int(np.prod(self._size) / area)):
                box = np.array([rng.uniform(*bounds) for bounds in sizes])
                x, y = rng.uniform([1.0, 1.0], self._size - 1.0 - box, size=2)
                low, high = ((np.array([x, y]) + [-margin, -margin]) / 0.05 for margin in (1.0, 0.0))
                end = (np.array([x, y]) + box + 1.0) / 0.05
                around = cells[int(low[1]) : int(end[1]), int(low[0]) : int(end[0])]
                if not around.any() and not self._is_on_a_way(np.array([x, y]) + 0.5 * box, box.max()):
                    self._canvas.fill(x, y, x + box[0], y + box[1])

    def _is_on_a_way(self, middle: np.ndarray, size: float) -> bool:
        for first, second in self._links:
            a, b = self._places[first], self._places[second]
            share = np.clip((middle - a) @ (b - a) / max((b - a) @ (b - a), 1e-9), 0.0, 1.0)
            if np.hypot(*(a + share * (b - a) - middle)) < 0.5 * (WAY_WIDTH + size):
                return True
        return False


def _into_rooms(passed: Sequence[np.ndarray], share: float, rng: np.random.Generator) -> Iterator[np.ndarray]:
    for way in passed:
        if rng.random() < share:
            yield from way
            yield from way[-2::-1]
