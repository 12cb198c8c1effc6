"""Odometry motion models (Probabilistic Robotics, table 5.6).

``diff`` and ``omni`` are amcl's: they use the variance of the book's formula as the standard deviation, and
``omni`` swaps two alphas; existing parameter files are tuned to that. ``diff-corrected`` and
``omni-corrected`` follow the book.
"""

import math
from typing import Tuple

import numba
import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.motion.custom_model import CONTRACT, MotionModel
from planar import Pose2, wrap

# Below this translation the motion counts as a rotation in place [m].
_NO_TRANSLATION = 0.01


def motion_model_of(settings: LocalizerSettings) -> MotionModel:
    """Create the selected model. Raises LocalizationError if a user-defined one cannot be created."""
    if settings.motion_plugin:
        return CONTRACT.make(settings.motion_plugin, settings)
    return AmclMotionModel(settings)


class AmclMotionModel:
    """The motion models of amcl and their corrected variants."""

    def __init__(self, settings: LocalizerSettings):
        self._settings = settings

    def moved(
        self, poses: np.ndarray, base_before: Pose2, base_now: Pose2, rng: np.random.Generator
    ) -> np.ndarray:
        """See MotionModel.moved."""
        return moved(poses, base_before, base_now, self._settings, rng)


def moved(
    poses: np.ndarray,
    base_before: Pose2,
    base_now: Pose2,
    settings: LocalizerSettings,
    rng: np.random.Generator,
) -> np.ndarray:
    """Predict particles (N, 3) from the motion between two odometry poses, with noise."""
    noise = rng.standard_normal((len(poses), 3))
    if settings.motion_model.startswith("diff"):
        return _moved_diff(poses, base_before, base_now, settings, noise)
    return _moved_omni(poses, base_before, base_now, settings, noise)


def _moved_diff(poses, base_before, base_now, settings, noise):
    rotation_1, translation, rotation_2 = rotations_and_translation(base_before, base_now)
    # Driving backwards counts as driving forwards: half a turn is no rotation.
    turn_1 = min(abs(wrap(rotation_1)), abs(wrap(rotation_1 - math.pi)))
    turn_2 = min(abs(wrap(rotation_2)), abs(wrap(rotation_2 - math.pi)))
    a1, a2, a3, a4 = (
        settings.rotation_from_rotation,
        settings.rotation_from_translation,
        settings.translation_from_translation,
        settings.translation_from_rotation,
    )
    spreads = _spreads(
        settings,
        a1 * turn_1**2 + a2 * translation**2,
        a3 * translation**2 + a4 * (turn_1**2 + turn_2**2),
        a1 * turn_2**2 + a2 * translation**2,
    )
    return _turned_driven_turned(poses, noise * spreads + (rotation_1, translation, rotation_2))


def _moved_omni(poses, base_before, base_now, settings, noise):
    dx, dy = base_now.x - base_before.x, base_now.y - base_before.y
    translation, rotation = math.hypot(dx, dy), wrap(base_now.yaw - base_before.yaw)
    a1, a2, a3, a4, a5 = (
        settings.rotation_from_rotation,
        settings.rotation_from_translation,
        settings.translation_from_translation,
        settings.translation_from_rotation,
        settings.strafe_from_translation,
    )
    if not settings.motion_model.endswith("corrected"):
        a1, a4 = a4, a1
    spreads = _spreads(
        settings,
        a3 * translation**2 + a4 * rotation**2,
        a1 * rotation**2 + a2 * translation**2,
        a4 * rotation**2 + a5 * translation**2,
    )
    bearing = math.atan2(dy, dx) - base_before.yaw
    return _shifted(poses, bearing, noise * spreads + (translation, rotation, 0.0))


@numba.njit(cache=True)
def _turned_driven_turned(poses, motions):
    """Move poses (N, 3) by a rotation, a translation and a rotation each (N, 3)."""
    moved_poses = np.empty_like(poses)
    for i in range(poses.shape[0]):
        direction = poses[i, 2] + motions[i, 0]
        moved_poses[i, 0] = poses[i, 0] + motions[i, 1] * math.cos(direction)
        moved_poses[i, 1] = poses[i, 1] + motions[i, 1] * math.sin(direction)
        moved_poses[i, 2] = _wrapped(direction + motions[i, 2])
    return moved_poses


@numba.njit(cache=True)
def _shifted(poses, bearing, motions):
    """Move poses (N, 3) by a translation along ``bearing``, a rotation and a strafe to the right (N, 3)."""
    moved_poses = np.empty_like(poses)
    for i in range(poses.shape[0]):
        forward, turn, strafe = motions[i]
        c, s = math.cos(poses[i, 2] + bearing), math.sin(poses[i, 2] + bearing)
        moved_poses[i, 0] = poses[i, 0] + forward * c + strafe * s
        moved_poses[i, 1] = poses[i, 1] + forward * s - strafe * c
        moved_poses[i, 2] = _wrapped(poses[i, 2] + turn)
    return moved_poses


@numba.njit(cache=True, inline="always")
def _wrapped(angle):
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def rotations_and_translation(base_before: Pose2, base_now: Pose2) -> Tuple[float, float, float]:
    """Decompose a motion into rotation [rad], translation [m] and rotation [rad]."""
    dx, dy = base_now.x - base_before.x, base_now.y - base_before.y
    translation = math.hypot(dx, dy)
    rotation_1 = 0.0 if translation < _NO_TRANSLATION else wrap(math.atan2(dy, dx) - base_before.yaw)
    return rotation_1, translation, wrap(base_now.yaw - base_before.yaw - rotation_1)


def _spreads(settings, *variances) -> np.ndarray:
    """Return standard deviations: roots of the variances or, as amcl does, the variances themselves."""
    return np.sqrt(variances) if settings.motion_model.endswith("corrected") else np.array(variances)
