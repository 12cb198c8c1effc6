"""Sets of weighted particles and how they start."""

from dataclasses import dataclass

import numba
import numpy as np

from amcl_lite.errors import LocalizationError
from planar import FREE, OccupancyGrid, Pose2
from planar.geometry.limits import MAX_COORDINATE


@dataclass(frozen=True, eq=False)
class ParticleSet:
    """``poses``: (N, 3) x, y, yaw in the map; ``weights``: (N,), their sum is 1."""

    poses: np.ndarray
    weights: np.ndarray

    @property
    def size(self) -> int:
        return len(self.weights)

    @property
    def effective_size(self) -> float:
        """How many equally weighted particles would tell as much (Liu, 1996)."""
        return 1.0 / float(np.sum(self.weights**2))


def equally_weighted(poses: np.ndarray) -> ParticleSet:
    """Particles at ``poses`` (N, 3), all of one weight."""
    return ParticleSet(poses, np.full(len(poses), 1.0 / len(poses)))


def gaussian_particles(
    mean: Pose2, covariance: np.ndarray, count: int, rng: np.random.Generator
) -> ParticleSet:
    """``count`` particles drawn from a normal distribution; see gaussian_poses."""
    return equally_weighted(gaussian_poses(mean, covariance, count, rng))


def gaussian_poses(mean: Pose2, covariance: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Poses (count, 3) from a normal distribution; ``covariance``: (3, 3), may be singular."""
    eigenvalues, eigenvectors = np.linalg.eigh(covariance)
    spread = eigenvectors * np.sqrt(np.maximum(eigenvalues, 0.0))
    return clamped_positions(mean.as_array() + rng.standard_normal((count, 3)) @ spread.T)


def clamped_positions(poses: np.ndarray) -> np.ndarray:
    """The poses (N, 3), with those beyond MAX_COORDINATE brought back to there: a robot can be no farther."""
    np.clip(poses[:, :2], -MAX_COORDINATE, MAX_COORDINATE, out=poses[:, :2])
    return poses


class FreeSpace:
    """The free cells of a map, to draw poses from. Raises LocalizationError if there are none."""

    def __init__(self, grid: OccupancyGrid):
        self._grid = grid
        # How many free cells there are up to the end of each row.
        self._counts = np.cumsum(np.count_nonzero(grid.cells == FREE, axis=1))
        if self._counts[-1] == 0:
            raise LocalizationError("the map has no free cell")

    def draw(self, count: int, rng: np.random.Generator) -> np.ndarray:
        """Poses (count, 3), uniform over the free area and all headings."""
        numbers = rng.integers(self._counts[-1], size=count)
        row_col = _cells_numbered(numbers, self._counts, self._grid.cells, FREE)
        within_cell = rng.uniform(-0.5, 0.5, (count, 2))
        positions_xy = self._grid.points_of(row_col + within_cell)
        return np.column_stack((positions_xy, rng.uniform(-np.pi, np.pi, count)))

    def contains(self, poses: np.ndarray) -> np.ndarray:
        """Which of the poses (N, 3) lie in a free cell: bool (N,)."""
        cells = self._grid.cells_of(poses[:, :2])
        is_free = self._grid.contains(cells)
        is_free[is_free] = self._grid.cells[tuple(cells[is_free].T)] == FREE
        return is_free


@numba.njit(cache=True)
def _cells_numbered(numbers, counts, cells, kind):
    """The cells (N, 2) that have these numbers among the cells of a kind, counted row by row."""
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
