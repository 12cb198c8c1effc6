"""What yards hold besides walls: hedges, fences and glass that beams partly pass, thin poles, moved cars."""

from typing import List, Sequence, Tuple

import numpy as np

from helpers.sites import Campus
from planar import OCCUPIED, OccupancyGrid, Pose2
from planar.geometry.ray_casting import cast_rays

# Along both sides of a path: distance of hedges from its middle, their thickness, the length of a section and
# of the gap after it [m].
BESIDE, THICKNESS, SECTION, GAP = (2.6, 4.0), (0.5, 1.2), (6.0, 25.0), (2.0, 9.0)
# Thickness of a fence or of glass [m], and which share of the sections these are.
THIN, THIN_SHARE = 0.05, 0.3
# Probability that a beam passes a hedge or fence, and mean depth at which leaves stop the others [m].
PASSES, LEAF_DEPTH = (0.3, 0.7), 0.12
# Distance of thin poles from each other along a path [m]; each is one cell.
POLE_STEP = 9.0
# Number of cars that are parked along paths, their size [m], and how many of them move between two passes.
CARS, CAR_SIZES, MOVED_SHARE = 40, (1.6, 4.5), 0.4


class Garden:
    """A campus with hedges, poles and cars, before and after some cars moved."""

    def __init__(self, campus: Campus, rng: np.random.Generator):
        self._resolution, self._origin = campus.grid.resolution, campus.grid.origin
        built = campus.grid.cells.copy()
        self._draw_poles(built, campus, rng)
        hedges = self._hedges(campus, rng)
        kept = self._cars(campus, round((1.0 - MOVED_SHARE) * CARS), rng)
        self._solid, self._porous = [], []
        for _ in range(2):
            cells = built.copy()
            self._draw(cells, [*kept, *self._cars(campus, round(MOVED_SHARE * CARS), rng)])
            self._solid.append(self._grid(cells))
            dense = cells.copy()
            self._draw(dense, hedges)
            self._porous.append(self._grid(dense))

    def ranges(
        self, laser: Pose2, angles: np.ndarray, max_range: float, is_late: bool, rng: np.random.Generator
    ) -> np.ndarray:
        """Measure ranges (N,) [m]; ``is_late``: whether the cars have moved."""
        behind = cast_rays(self._solid[is_late], laser, angles, max_range)
        first = cast_rays(self._porous[is_late], laser, angles, max_range)
        x, y = laser.x + first * np.cos(laser.yaw + angles), laser.y + first * np.sin(laser.yaw + angles)
        low, high = PASSES
        passes = 0.5 * (low + high) + 0.5 * (high - low) * np.sin(0.7 * x + 1.3 * y)
        stopped = first + rng.exponential(LEAF_DEPTH, len(angles))
        is_stopped = (first < behind) & (rng.random(len(angles)) > passes)
        return np.where(is_stopped, np.minimum(stopped, behind), behind)

    def _grid(self, cells: np.ndarray) -> OccupancyGrid:
        return OccupancyGrid(cells, self._resolution, self._origin)

    def _draw(self, cells: np.ndarray, boxes: Sequence[Tuple[np.ndarray, np.ndarray]]) -> None:
        for low, high in boxes:
            (col, row), (end_col, end_row) = (np.rint(np.array([low, high]) / self._resolution)).astype(int)
            cells[max(row, 0) : max(end_row, row + 1), max(col, 0) : max(end_col, col + 1)] = OCCUPIED

    def _draw_poles(self, cells: np.ndarray, campus: Campus, rng: np.random.Generator) -> None:
        poles = []
        for start, end in campus.yard_paths:
            direction = (end - start) / np.hypot(*(end - start))
            for along in np.arange(POLE_STEP, np.hypot(*(end - start)) - 5.0, POLE_STEP):
                side = rng.choice([-1.0, 1.0]) * rng.uniform(2.2, 3.0)
                place = start + along * direction + side * np.array([-direction[1], direction[0]])
                poles.append((place, place))
        self._draw(cells, poles)

    def _hedges(self, campus: Campus, rng: np.random.Generator) -> List[Tuple[np.ndarray, np.ndarray]]:
        """Boxes along the paths of the yard, which leave the crossings and doors free."""
        boxes = []
        for start, end in campus.yard_paths:
            length = np.hypot(*(end - start))
            direction = (end - start) / length
            for side in (-1.0, 1.0):
                normal = side * np.array([-direction[1], direction[0]])
                along = rng.uniform(5.0, 9.0)
                while along < length - 8.0:
                    size = min(rng.uniform(*SECTION), length - 5.0 - along)
                    thickness = THIN if rng.random() < THIN_SHARE else rng.uniform(*THICKNESS)
                    near = start + along * direction + rng.uniform(*BESIDE) * normal
                    corners = np.array([near, near + size * direction + thickness * normal])
                    boxes.append((corners.min(axis=0), corners.max(axis=0)))
                    along += size + rng.uniform(*GAP)
        return [box for box in boxes if not campus.blocks_path(*box)]

    def _cars(self, campus: Campus, count: int, rng: np.random.Generator):
        """Boxes (low, high) beside the paths of the yard."""
        boxes: List[Tuple[np.ndarray, np.ndarray]] = []
        paths = campus.yard_paths
        while len(boxes) < count:
            start, end = paths[rng.integers(len(paths))]
            direction = (end - start) / np.hypot(*(end - start))
            normal = rng.choice([-1.0, 1.0]) * np.array([-direction[1], direction[0]])
            middle = start + rng.uniform(0.1, 0.9) * (end - start) + rng.uniform(5.5, 9.0) * normal
            size = rng.permutation(CAR_SIZES)
            box = (middle - 0.5 * size, middle + 0.5 * size)
            boxes += [] if campus.blocks_path(*box) else [box]
        return boxes
