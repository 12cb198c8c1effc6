"""The contract of a motion model, and the selection by the settings.

``motion_plugin: my_package.my_module/MyModel`` selects a user-defined model instead of ``odom_model_type``.
"""

from typing import Protocol

import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.custom_model import CustomModel
from amcl_lite.motion import motion_model
from planar import Pose2
from planar.geometry.limits import MAX_COORDINATE
from planar.plugins import PluginContract


class MotionModel(Protocol):
    """A motion model; created again when settings change."""

    def __init__(self, settings: LocalizerSettings): ...

    def moved(
        self, poses: np.ndarray, base_before: Pose2, base_now: Pose2, rng: np.random.Generator
    ) -> np.ndarray:
        """Predict particles from the motion of the odometry.

        Args:
            poses: (N, 3) x, y, yaw in the map [m, rad].
            base_before: Odometry pose at the last update.
            base_now: Odometry pose now.
            rng: Source of all randomness.

        Returns:
            Predicted poses (N, 3).
        """
        ...


CONTRACT = PluginContract("motion model", MotionModel, LocalizerSettings, "amcl_lite.motion_models")


def motion_model_of(settings: LocalizerSettings) -> MotionModel:
    """Create the selected model. Raises LocalizationError if a user-defined one cannot be created."""
    return CustomMotionModel(settings) if settings.motion_plugin else AmclMotionModel(settings)


class AmclMotionModel:
    """The motion models of amcl and their corrected variants."""

    def __init__(self, settings: LocalizerSettings):
        self._settings = settings

    def moved(
        self, poses: np.ndarray, base_before: Pose2, base_now: Pose2, rng: np.random.Generator
    ) -> np.ndarray:
        return motion_model.moved(poses, base_before, base_now, self._settings, rng)


class CustomMotionModel:
    """A user-defined motion model whose results are checked."""

    def __init__(self, settings: LocalizerSettings):
        self._custom = CustomModel(settings.motion_plugin, CONTRACT, settings)

    def moved(
        self, poses: np.ndarray, base_before: Pose2, base_now: Pose2, rng: np.random.Generator
    ) -> np.ndarray:
        """Raises LocalizationError."""
        given = (poses.copy(), base_before, base_now, rng)
        return self._custom.call("moved", poses.shape, *given, most=MAX_COORDINATE)
