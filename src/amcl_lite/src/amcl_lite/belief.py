"""The belief of a Localizer (its particles), and files from which another Localizer resumes."""

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
    """State of a particle filter.

    Attributes:
        particles: Particles at the odometry pose ``base_in_odom``.
        base_in_odom: Odometry pose of the last update.
        odom_in_map: Pose of the odometry frame in the map.
        is_lost: Whether the scans contradict the estimate.
    """

    particles: ParticleSet
    base_in_odom: Pose2
    odom_in_map: Pose2
    is_lost: bool = False


def save_particles(particles: ParticleSet, path) -> None:
    """Write particles atomically. Raises FileWriteError."""
    file = io.BytesIO()
    np.save(file, np.column_stack((particles.poses, particles.weights)))
    write_atomically(path, file.getvalue())


def load_particles(path) -> ParticleSet:
    """Read particles that ``save_particles`` has written. Raises LocalizationError."""
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
        raise LocalizationError(
            f"{path}: malformed particles: poses out of range, or weights that do not sum to 1"
        )
    return ParticleSet(poses, weights)
