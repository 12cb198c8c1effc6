"""Cells of a map that the beams of a lidar have reached."""

import math

import numba
import numpy as np

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, Scan

# Bits of a cell: not reached by a beam yet, free floor, blocks beams.
UNSEEN, FLOOR, SOLID = np.uint8(1), np.uint8(2), np.uint8(4)


class ExploredArea:
    """The explored part of a map.

    Attributes:
        explored: Reached cells, bool (rows, cols).
    """

    def __init__(self, grid: OccupancyGrid):
        self._map_in_grid, self._resolution = grid.origin.inverse(), grid.resolution
        is_free = grid.cells == FREE
        cells = UNSEEN + FLOOR * is_free + SOLID * (grid.cells == OCCUPIED)
        self._cells = np.pad(cells, 1, constant_values=SOLID)  # no beam leaves the map
        self._seen = np.zeros(self._cells.shape, dtype=np.bool_)
        self.explored = self._seen[1:-1, 1:-1]
        self._all, self._count = max(int(np.count_nonzero(is_free)), 1), 0

    @property
    def share(self) -> float:
        """Explored share of the free area."""
        return self._count / self._all

    def add_scan(self, base_in_map: Pose2, scan: Scan) -> float:
        """Add the cells along the beams of a scan; return the newly explored free area [m2]."""
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
    """Mark the cells along beams and one beyond; return the number of new free cells."""
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
    """Mark the cells of a beam that advances faster along than across; each step visits one or two cells.

    Both are always visited: a branch would be mispredicted too often.
    """
    start, new_cells = math.floor(along), 0
    first_step = along - start if run < 0.0 else start + 1.0 - along
    step = -stride_along if run < 0.0 else stride_along
    slope, end = rise / abs(run), reach * abs(run)
    row = int(start) * stride_along
    near = row + int(across) * stride_across
    for steps in range(max(math.ceil(end - first_step), 0) + 1):
        far = row + int(across + slope * min(first_step + steps, end)) * stride_across
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
