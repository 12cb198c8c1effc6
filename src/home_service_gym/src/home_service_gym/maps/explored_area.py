"""Which cells of a map the beams of a lidar have reached."""

import math

import numba
import numpy as np

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, Scan

# What a cell may be: no beam has reached it yet, it is free floor besides, it lets no beam through.
UNSEEN, FLOOR, SOLID = np.uint8(1), np.uint8(2), np.uint8(4)


class ExploredArea:
    """``known``: which cells of a grid have been reached, bool (rows, cols); ``share``: of its free floor."""

    def __init__(self, grid: OccupancyGrid):
        self._map_in_grid, self._resolution = grid.origin.inverse(), grid.resolution
        is_free = grid.cells == FREE
        cells = UNSEEN + FLOOR * is_free + SOLID * (grid.cells == OCCUPIED)
        self._cells = np.pad(cells, 1, constant_values=SOLID)  # which no beam leaves
        self._seen = np.zeros(self._cells.shape, dtype=np.bool_)
        self.explored = self._seen[1:-1, 1:-1]
        self._all, self._count = max(int(np.count_nonzero(is_free)), 1), 0

    @property
    def share(self) -> float:
        return self._count / self._all

    def add_scan(self, base_in_map: Pose2, scan: Scan) -> float:
        """Takes in what beams have gone through, and what they have met; returns the new free floor, m^2."""
        laser = self._map_in_grid @ base_in_map @ scan.laser_in_base
        turn = -1.0 if scan.upside_down else 1.0
        new_cells = _mark(
            self._cells,
            self._seen,
            laser.x / self._resolution + 1.0,
            laser.y / self._resolution + 1.0,
            laser.yaw + turn * scan.angle_min,
            turn * scan.angle_increment,
            scan.ranges,
            scan.range_max,
            self._resolution,
        )
        self._count += new_cells
        return new_cells * self._resolution**2


@numba.njit(cache=True)
def _mark(cells, seen, x, y, first, increment, ranges, most, resolution):
    """Marks what lies along beams, and a cell beyond, as seen; returns how much free floor is new.

    ``x`` and ``y``, of the laser, are in cells.
    """
    rows, cols = cells.shape
    if not (0.0 <= y < rows and 0.0 <= x < cols):
        return 0
    flat, seen_flat, new_cells = cells.ravel(), seen.ravel(), 0
    dx, dy, dx_next, dy_next = math.cos(first), math.sin(first), math.cos(increment), math.sin(increment)
    for beam in range(ranges.size):
        reach = min(max(ranges[beam], 0.0), most) / resolution + 1.0
        if abs(dx) >= abs(dy):
            new_cells += _mark_beam(flat, seen_flat, x, y, dx, dy, 1, cols, reach)
        else:
            new_cells += _mark_beam(flat, seen_flat, y, x, dy, dx, cols, 1, reach)
        dx, dy = dx * dx_next - dy * dy_next, dy * dx_next + dx * dy_next
    return new_cells


@numba.njit(cache=True)
def _mark_beam(cells, seen, along, across, run, rise, stride_along, stride_across, reach):
    """Of a beam that goes farther along than across: at each step along, it is in one cell or in two.

    Whether they are two is not asked, as no processor guesses that well, and each is looked at without ado.
    """
    begin, new_cells = math.floor(along), 0
    way = along - begin if run < 0.0 else begin + 1.0 - along
    step = -stride_along if run < 0.0 else stride_along
    slope, end = rise / abs(run), reach * abs(run)
    row = int(begin) * stride_along
    near = row + int(across) * stride_across
    for steps in range(max(math.ceil(end - way), 0) + 1):
        far = row + int(across + slope * min(way + steps, end)) * stride_across
        if cells[np.uint64(near)] | cells[np.uint64(far)]:
            for at in (near, far):
                cell = cells[at]
                if cell & UNSEEN:
                    cells[at], seen[at] = cell & SOLID, True
                    new_cells += (cell & FLOOR) != 0
                if cell & SOLID:
                    return new_cells
        near, row = far + step, row + step
    return new_cells
