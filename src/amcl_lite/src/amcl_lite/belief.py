"""What a Localizer believes, kept in a file for one that goes on after it."""

import io
from dataclasses import dataclass

import numpy as np

from amcl_lite.errors import LocalizationError
from amcl_lite.filter.particles import ParticleSet
from planar import Pose2, write_atomically
from planar.files.reading import read_array
from planar.geometry.limits import MAX_COORDINATE


@dataclass(frozen=True, eq=False)
class Belief:
    """``particles``: when odometry had the robot at ``base_in_odom``.

    ``is_lost``: whether scans had not fitted the map for some time.
    """

    particles: ParticleSet
    base_in_odom: Pose2
    odom_in_map: Pose2
    is_lost: bool = False


def save_particles(particles: ParticleSet, path) -> None:
    """Writes particles, whole or not at all. Raises FileWriteError."""
    file = io.BytesIO()
    np.save(file, np.column_stack((particles.poses, particles.weights)))
    write_atomically(path, file.getvalue())


def load_particles(path) -> ParticleSet:
    """Reads what ``save_particles`` wrote. Raises LocalizationError."""
    try:
        table = read_array(path)
    except (OSError, ValueError) as error:
        raise LocalizationError(f"{path}: no readable particles ({error})") from None
    if table.dtype != np.float64 or table.ndim != 2 or table.shape[1] != 4 or len(table) == 0:
        raise LocalizationError(f"{path}: no particles")
    poses, weights = np.ascontiguousarray(table[:, :3]), table[:, 3].copy()
    is_sound = (
        (np.abs(poses) <= MAX_COORDINATE).all() and (weights >= 0.0).all() and abs(weights.sum() - 1.0) < 1e-6
    )
    if not is_sound:
        raise LocalizationError(f"{path}: particles that mean nothing")
    return ParticleSet(poses, weights)
