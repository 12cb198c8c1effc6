"""Buildings and whole sites, generated from a seed, and routes of a robot through them."""

from dataclasses import dataclass
from typing import Iterator, List, Sequence, Tuple

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2

WALL, CORRIDOR, DOOR = 0.15, 2.2, 0.95
# Distance of the nearest path from a building, and of the outer paths from the site's border [m].
YARD, BORDER = 10.0, 6.0
# Area of a site per tree, and per parked car or bench [m^2]; none stands on a path.
TREE_AREA, CAR_AREA, PATH_WIDTH = 500.0, 900.0, 4.0


@dataclass(frozen=True)
class Building:
    """The plan of a building: blocks of rooms with corridors around them.

    Attributes:
        columns: Number of blocks along x.
        rows: Number of blocks along y.
        block: Size of a block (x, y) [m].
        room_width: Least and largest width of a room [m].
        visits: Fraction of the rooms along the route that the robot enters.
        is_repetitive: Whether all blocks are identical, including the furniture.
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
    """A grid to draw obstacles on, ``size`` metres (x, y) large, with its first cell at ``corner`` (x, y)."""

    def __init__(self, corner, size, resolution: float, value: int):
        self._corner, self._resolution = np.asarray(corner, dtype=float), resolution
        shape = np.ceil(np.asarray(size) / resolution).astype(int)[::-1]
        self._cells = np.full(shape, value, dtype=np.int8)

    def fill(self, x0: float, y0: float, x1: float, y1: float, value: int = OCCUPIED) -> None:
        """Set the cells of a box."""
        edges = (np.array([x0, y0, x1, y1]) - np.tile(self._corner, 2)) / self._resolution
        col, row, end_col, end_row = (max(0, round(edge)) for edge in edges)
        self._cells[row:end_row, col:end_col] = value

    def grid(self) -> OccupancyGrid:
        """Return the grid."""
        return OccupancyGrid(self._cells, self._resolution, Pose2(*self._corner))


class Floor:
    """A building drawn on a canvas with its inner ``corner`` at (x, y).

    Attributes:
        plan: Of the building.
        rooms: Route (3, 2) into each room from the corridor.
        crossings: (N, 2), of corridors, column and row.
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
        """Position (2,) of a crossing of corridors."""
        return self._corner + self.plan.pitch * crossing + 0.5 * CORRIDOR

    def rooms_between(self, start: np.ndarray, end: np.ndarray) -> List[np.ndarray]:
        """Routes into the rooms along the corridor from ``start`` to ``end``, in this order."""
        low, high = sorted((start[0], end[0]))
        along = [
            route
            for route in self.rooms
            if abs(route[0, 1] - start[1]) < 0.1 and abs(start[1] - end[1]) < 0.1
        ]
        passed = [route for route in along if low < route[0, 0] < high]
        return sorted(passed, key=lambda route: abs(route[0, 0] - start[0]))

    def open_to(self, place: np.ndarray) -> None:
        """Open a door in the outer wall, between the corridor's end and ``place`` above or below it."""
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
        """Draw a room with a door in the wall along x through ``corner``, and furniture beside the route."""
        sign = 1.0 if upwards else -1.0
        self._fill_room(corner, sign, (WALL, WALL, width - WALL, depth - WALL), 0)
        door = self._rng.uniform(0.3, max(width - DOOR - 0.3, 0.31))
        self._fill_room(corner, sign, (door, 0.0, door + DOOR, WALL), 0)
        route_x = door + 0.5 * DOOR
        inside = self._rng.uniform(1.0, max(depth - 1.0, 1.1))
        for _ in range(self._rng.integers(2, 6)):
            x, y = self._rng.uniform(WALL, width - WALL), self._rng.uniform(WALL, depth - WALL)
            size = self._rng.uniform(0.2, 1.2, 2)
            if abs(x - route_x) > 0.5 * size[0] + 0.45 or y - 0.5 * size[1] > inside + 0.5:
                box = (max(x - 0.5 * size[0], 0.0), max(y - 0.5 * size[1], 0.0))
                self._fill_room(
                    corner, sign, (*box, min(x + 0.5 * size[0], width), min(y + 0.5 * size[1], depth))
                )
        route = [(route_x, -0.5 * CORRIDOR), (route_x, 0.0), (route_x, inside)]
        self.rooms.append(self._corner + corner + np.array(route) * [1.0, sign])

    def _fill_room(self, corner: np.ndarray, sign: float, box, value: int = OCCUPIED) -> None:
        x0, y0, x1, y1 = box
        ys = sorted((corner[1] + sign * y0, corner[1] + sign * y1))
        self._fill(corner[0] + x0, ys[0], corner[0] + x1, ys[1], value)

    def _fill(self, x0: float, y0: float, x1: float, y1: float, value: int = OCCUPIED) -> None:
        x, y = self._corner
        self._canvas.fill(x + x0, y + y0, x + x1, y + y1, value)


class House:
    """One building: the true ``grid``, and an endless route through its corridors and rooms."""

    def __init__(self, plan: Building, rng: np.random.Generator, resolution: float = 0.025):
        canvas = Canvas((-WALL, -WALL), plan.size + 2.0 * WALL, resolution, FREE)
        self._floor = Floor(plan, canvas, (0.0, 0.0), rng)
        self.grid = canvas.grid()

    def walk(self, rng: np.random.Generator) -> Iterator[np.ndarray]:
        """Yield waypoints (x, y): along corridors, into rooms, straight back only at dead ends."""
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
    """Buildings in a yard of ``slots`` (columns, rows), ``size`` metres (x, y), with paths, trees and cars.

    A route leads through one building after the other, across the yard between them, and back to its start,
    where its first part is repeated.
    """

    def __init__(self, buildings: Sequence[Building], slots: Tuple[int, int], size, rng: np.random.Generator):
        self._canvas = Canvas((0.0, 0.0), size, 0.05, FREE)
        self._size, self._slots = np.asarray(size, dtype=float), np.asarray(slots)
        self._places: List[np.ndarray] = []
        self._links: List[Tuple[int, int]] = []
        # Floor of each place, or -1.
        self._floor_of: List[int] = []
        self._build_roads()
        self.floors = [self._build(plan, slot, rng) for slot, plan in enumerate(buildings)]
        self._furnish(rng)
        self.grid = self._canvas.grid()
        ends = np.array(self._links)
        lengths = [float(np.hypot(*(self._places[a] - self._places[b]))) for a, b in self._links]
        self._graph = csr_matrix((lengths, tuple(ends.T)), shape=(len(self._places),) * 2)

    @property
    def yard_paths(self) -> List[Tuple[np.ndarray, np.ndarray]]:
        """Both ends (2,) of each path outside of the buildings, also of those to their doors."""
        ends = [(a, b) for a, b in self._links if self._floor_of[a] < 0 and self._floor_of[b] < 0]
        return [(self._places[a], self._places[b]) for a, b in ends]

    def blocks_path(self, low: np.ndarray, high: np.ndarray) -> bool:
        """Whether a box comes within half a metre of the way of the robot, or touches a building."""
        cells = self.grid.cells
        col, row, end_col, end_row = np.rint(np.concatenate((low, high)) / self.grid.resolution).astype(int)
        if (cells[max(row, 0) : end_row + 1, max(col, 0) : end_col + 1] == OCCUPIED).any():
            return True
        for first, second in self._links:
            ends = np.array([self._places[first], self._places[second]])
            if (ends.min(axis=0) < high + 1.0).all() and (ends.max(axis=0) > low - 1.0).all():
                return True
        return False

    def walk(self, rng: np.random.Generator, stops: int = 3, again: int = 4) -> Iterator[np.ndarray]:
        """Yield waypoints (x, y): ``stops`` crossings in each building, then the first ``again`` ones."""
        tour: List[int] = []
        for number in range(len(self.floors)):
            inside = [place for place, on in enumerate(self._floor_of) if on == number]
            tour += [int(place) for place in rng.choice(inside, stops, replace=False)]
        route = [tour[0]]
        for goal in [*tour[1:], tour[0]]:
            route += self._shortest_path(route[-1], goal)[1:]
        route += route[1:again]
        yield self._places[route[0]]
        for last, here in zip(route, route[1:]):
            start, end = self._places[last], self._places[here]
            if self._floor_of[last] == self._floor_of[here] >= 0:
                floor = self.floors[self._floor_of[last]]
                yield from _into_rooms(floor.rooms_between(start, end), floor.plan.visits, rng)
            yield end

    def _shortest_path(self, start: int, goal: int) -> List[int]:
        """The shortest path between two places."""
        _, before = dijkstra(self._graph, directed=False, indices=start, return_predecessors=True)
        route = [goal]
        while route[-1] != start:
            route.append(int(before[route[-1]]))
        return route[::-1]

    def _add(self, place, floor: int = -1) -> int:
        self._places.append(np.asarray(place, dtype=float))
        self._floor_of.append(floor)
        return len(self._places) - 1

    def _road_xy(self, column: int, row: int) -> np.ndarray:
        return BORDER + (self._size - 2.0 * BORDER) * [column, row] / self._slots

    def _build_roads(self) -> None:
        """Make a lattice of paths around the slots; places are numbered row by row."""
        columns, rows = self._slots + 1
        for row in range(rows):
            for column in range(columns):
                here = self._add(self._road_xy(column, row))
                self._links += [(here - 1, here)] if column else []
                self._links += [(here - columns, here)] if row else []

    def _build(self, plan: Building, slot: int, rng: np.random.Generator) -> Floor:
        """Draw a building somewhere in its slot, with doors to the path below and the path above."""
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
        """Draw trees and cars in the yard, away from paths and buildings."""
        cells = self._canvas.grid().cells
        for area, sizes in ((TREE_AREA, ((0.25, 0.6), (0.25, 0.6))), (CAR_AREA, ((1.6, 4.5), (1.6, 4.5)))):
            for _ in range(int(np.prod(self._size) / area)):
                box = np.array([rng.uniform(*bounds) for bounds in sizes])
                x, y = rng.uniform([1.0, 1.0], self._size - 1.0 - box, size=2)
                low, high = ((np.array([x, y]) + [-margin, -margin]) / 0.05 for margin in (1.0, 0.0))
                end = (np.array([x, y]) + box + 1.0) / 0.05
                around = cells[int(low[1]) : int(end[1]), int(low[0]) : int(end[0])]
                if not around.any() and not self._is_on_path(np.array([x, y]) + 0.5 * box, box.max()):
                    self._canvas.fill(x, y, x + box[0], y + box[1])

    def _is_on_path(self, middle: np.ndarray, size: float) -> bool:
        for first, second in self._links:
            a, b = self._places[first], self._places[second]
            share = np.clip((middle - a) @ (b - a) / max((b - a) @ (b - a), 1e-9), 0.0, 1.0)
            if np.hypot(*(a + share * (b - a) - middle)) < 0.5 * (PATH_WIDTH + size):
                return True
        return False


def _into_rooms(passed: Sequence[np.ndarray], share: float, rng: np.random.Generator) -> Iterator[np.ndarray]:
    for route in passed:
        if rng.random() < share:
            yield from route
            yield from route[-2::-1]
