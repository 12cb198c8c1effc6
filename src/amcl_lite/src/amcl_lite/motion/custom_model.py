"""The contract of a user-defined motion model.

``motion_plugin: my_package.my_module/MyModel`` selects it instead of ``odom_model_type``.
"""

from typing import Any, Protocol

import numpy as np

from amcl_lite.custom_model import finite_numbers
from amcl_lite.errors import LocalizationError
from planar import Pose2
from planar.extensions import ExtensionPoint
from planar.geometry.limits import MAX_COORDINATE


class MotionModel(Protocol):
    """A motion model; created again when settings change."""

    def __init__(self, settings: Any): ...

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


def _checked(moved: Any, poses: np.ndarray, *given: Any) -> np.ndarray:
    return finite_numbers(moved, poses.shape, MAX_COORDINATE)


CONTRACT: ExtensionPoint[MotionModel] = ExtensionPoint(
    "motion model", MotionModel, "amcl_lite.motion_models", LocalizationError, answers={"moved": _checked}
)
