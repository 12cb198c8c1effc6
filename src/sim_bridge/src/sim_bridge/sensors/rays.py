"""Rays of a range finder: which beams it casts, and the ranges that it makes of them (Gazebo's RaySensor)."""

from dataclasses import dataclass
from typing import Tuple

import numpy as np

from sim_bridge.sensors.base import SensorContext

# Cosine of the tilt up to which a laser counts as level, 0.2 degrees: a robot on a floor tilts as much.
LEVEL_COSINE = 1.0 - 6e-6


@dataclass(frozen=True)
class RayGrid:
    """Rays in rows of equal elevation, and the ranges that are interpolated between them.

    Attributes:
        angle_min: Bearing of the first ray of a row [rad].
        angle_max: Bearing of the last ray of a row [rad].
        columns: Rays of a row.
        elevations: Elevation of each row of rays [rad].
        ranges: Ranges of a row of the result.
        rows: Rows of the result.
    """

    angle_min: float
    angle_max: float
    columns: int
    elevations: Tuple[float, ...]
    ranges: int
    rows: int

    @property
    def is_one_level_row(self) -> bool:
        """Whether there is one row of rays, without elevation."""
        return self.elevations == (0.0,)

    @property
    def increment(self) -> float:
        """Angle between two rays of a row [rad]; any for a single one."""
        return (self.angle_max - self.angle_min) / (self.columns - 1) if self.columns > 1 else 1.0

    def directions(self) -> np.ndarray:
        """Return the directions (R * C, 3) of all rays in the laser frame, row by row."""
        row = np.linspace(self.angle_min, self.angle_max, self.columns)
        bearings = np.tile(row, len(self.elevations))
        elevations = np.repeat(self.elevations, self.columns)
        level = np.cos(elevations)
        return np.column_stack((level * np.cos(bearings), level * np.sin(bearings), np.sin(elevations)))

    def interpolate(self, lengths: np.ndarray, sight: float) -> np.ndarray:
        """Return the ranges, interpolated between the lengths of the four nearest rays.

        Args:
            lengths: Length (R * C,) of each ray, infinite without a hit [m].
            sight: Length of a ray without a hit [m].

        Returns:
            The ranges (N,), row by row; infinite from ``sight`` on [m].
        """
        if self.ranges == self.columns and self.rows == len(self.elevations):
            return lengths
        grid = np.minimum(lengths, sight).reshape(len(self.elevations), self.columns)
        ranges = _between(_between(grid, self.rows).T, self.ranges).T.ravel()
        return np.where(ranges < sight, ranges, np.inf)

    def nearest(self, values: np.ndarray) -> np.ndarray:
        """Return the value (N,) of the ray nearest to each range, of values (R * C,) of the rays."""
        if self.ranges == self.columns and self.rows == len(self.elevations):
            return values
        grid = values.reshape(len(self.elevations), self.columns)
        rows, columns = (
            np.rint(_positions(size, count)).astype(int)
            for size, count in zip(grid.shape, (self.rows, self.ranges))
        )
        return grid[rows][:, columns].ravel()


def is_level(pose_in_base: np.ndarray) -> bool:
    """Return whether a laser (4, 4) sweeps horizontally, upright or upside down."""
    return bool(abs(pose_in_base[2, 2]) >= LEVEL_COSINE)


def cast_in_space(
    context: SensorContext, pose_in_base: np.ndarray, directions: np.ndarray, sight: float
) -> Tuple[np.ndarray, np.ndarray]:
    """Cast the rays of a laser in any orientation.

    Args:
        context: State of the robot and of the world.
        pose_in_base: Pose (4, 4) of the laser.
        directions: Directions (N, 3) of the rays in the laser frame.
        sight: Largest range [m].

    Returns:
        The length (N,) of each ray, infinite without a hit [m], and the laser_retro (N,) of what it hits.
    """
    laser = context.base.pose @ pose_in_base
    return context.cast_rays(laser[:3, 3], directions @ laser[:3, :3].T, sight)


def _positions(size: int, count: int) -> np.ndarray:
    """Return the position of each of ``count`` results among ``size`` values."""
    return np.arange(count) * (size - 1) / max(count - 1, 1)


def _between(values: np.ndarray, count: int) -> np.ndarray:
    """Interpolate rows (M, K) linearly to ``count`` rows."""
    at = _positions(len(values), count)
    below = np.floor(at).astype(int)
    above = np.minimum(below + 1, len(values) - 1)
    share = (at - below)[:, None]
    return (1.0 - share) * values[below] + share * values[above]
