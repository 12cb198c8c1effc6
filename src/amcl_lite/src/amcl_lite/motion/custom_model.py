"""The contract of a motion model, and which one the settings choose.

One of somebody's own is chosen by ``motion_plugin: my_package.my_module/MyModel`` and takes the place of
``odom_model_type``.
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
    """Made whenever settings change."""

    def __init__(self, settings: LocalizerSettings): ...

    def moved(
        self, poses: np.ndarray, base_before: Pose2, base_now: Pose2, rng: np.random.Generator
    ) -> np.ndarray:
        """Particles (N, 3) moved on as the odometry moved, with noise of ``rng``: (N, 3)."""
        ...


CONTRACT = PluginContract("motion model", MotionModel, LocalizerSettings, "amcl_lite.motion_models")


def motion_model_of(settings: LocalizerSettings) -> MotionModel:
    """Raises LocalizationError if one of somebody's own cannot be made."""
    return CustomMotionModel(settings) if settings.motion_plugin else AmclMotionModel(settings)


class AmclMotionModel:
    """Those of amcl."""

    def __init__(self, settings: LocalizerSettings):
        self._settings = settings

    def moved(
        self, poses: np.ndarray, base_before: Pose2, base_now: Pose2, rng: np.random.Generator
    ) -> np.ndarray:
        return motion_model.moved(poses, base_before, base_now, self._settings, rng)


class CustomMotionModel:
    """One of other people: what it gives is checked, what goes wrong in it is its fault."""

    def __init__(self, settings: LocalizerSettings):
        self._custom = CustomModel(settings.motion_plugin, CONTRACT, settings)

    def moved(
        self, poses: np.ndarray, base_before: Pose2, base_now: Pose2, rng: np.random.Generator
    ) -> np.ndarray:
        """Raises LocalizationError."""
        given = (poses.copy(), base_before, base_now, rng)
        return self._custom.call("moved", poses.shape, *given, most=MAX_COORDINATE)
