"""Sets of weighted particles and their initial distributions."""

from dataclasses import dataclass

import numba
import numpy as np

from amcl_lite.errors import LocalizationError
from planar import FREE, OccupancyGrid, Pose2
from planar.geometry.limits import MAX_COORDINATE


@dataclass(frozen=True, eq=False)
class ParticleSet:
    """Weighted particles.

    Attributes:
        poses: (N, 3) x, y, yaw in the map [m, rad].
        weights: (N,), with sum 1.
    """

    poses: np.ndarray
    weights: np.ndarray

    @property
    def size(self) -> int:
        return len(self.weights)

    @property
    def effective_size(self) -> float:
        """Effective sample size (Liu, 1996)."""
        return 1.0 / float(np.sum(self.weights**2))


def equally_weighted(poses: np.ndarray) -> ParticleSet:
    """Return particles of equal weight at ``poses`` (N, 3)."""
    return ParticleSet(poses, np.full(len(poses), 1.0 / len(poses)))


def gaussian_particles(
    mean: Pose2, covariance: np.ndarray, count: int, rng: np.random.Generator
) -> ParticleSet:
    """Draw particles of equal weight from a normal distribution; see gaussian_poses."""
    return equally_weighted(gaussian_poses(mean, covariance, count, rng))


def gaussian_poses(mean: Pose2, covariance: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Draw poses (count, 3) from a normal distribution with covariance (3, 3), which may be singular."""
    eigenvalues, eigenvectors = np.linalg.eigh(covariance)
    spread = eigenvectors * np.sqrt(np.maximum(eigenvalues, 0.0))
    return clamped_positions(mean.as_array() + rng.standard_normal((count, 3)) @ spread.T)


def clamped_positions(poses: np.ndarray) -> np.ndarray:
    """Clamp the positions of poses (N, 3) to MAX_COORDINATE, in place."""
    np.clip(poses[:, :2], -MAX_COORDINATE, MAX_COORDINATE, out=poses[:, :2])
    return poses


class FreeSpace:
    """The free cells of a map, from which poses are drawn. Raises LocalizationError if there are none."""

    def __init__(self, grid: OccupancyGrid):
        self._grid = grid
        # Number of free cells up to the end of each row.
        self._counts = np.cumsum(np.count_nonzero(grid.cells == FREE, axis=1))
        if self._counts[-1] == 0:
            raise LocalizationError("the map has no free cell")

    def draw(self, count: int, rng: np.random.Generator) -> np.ndarray:
        """Draw poses (count, 3), uniform over the free area and all headings."""
        numbers = rng.integers(self._counts[-1], size=count)
        row_col = _cells_numbered(numbers, self._counts, self._grid.cells, FREE)
        within_cell = rng.uniform(-0.5, 0.5, (count, 2))
        positions_xy = self._grid.points_of(row_col + within_cell)
        return np.column_stack((positions_xy, rng.uniform(-np.pi, np.pi, count)))

    def contains(self, poses: np.ndarray) -> np.ndarray:
        """Return for poses (N, 3) whether each lies in a free cell: bool (N,)."""
        cells = self._grid.cells_of(poses[:, :2])
        is_free = self._grid.contains(cells)
        is_free[is_free] = self._grid.cells[tuple(cells[is_free].T)] == FREE
        return is_free


@numba.njit(cache=True)
def _cells_numbered(numbers, counts, cells, kind):
    """Return the cells (N, 2) with these numbers among the cells of a kind, counted row by row."""
    row_col = np.empty((numbers.size, 2), dtype=np.int64)
    for i in range(numbers.size):
        row = np.searchsorted(counts, numbers[i], side="right")
        left = counts[row] - numbers[i]
        col = cells.shape[1]
        while left > 0:
            col -= 1
            if cells[row, col] == kind:
                left -= 1
        row_col[i, 0], row_col[i, 1] = row, col
    return row_col
