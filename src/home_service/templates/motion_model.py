"""TITLE: a motion model for amcl_lite."""

import numpy as np

from amcl_lite import LocalizerSettings
from planar import Pose2
from planar.geometry.pose import cos_sin

# Standard deviations of odometry: translation and rotation per metre, and per radian.
PER_METRE, PER_RADIAN = (0.1, 0.05), (0.02, 0.1)


class CLASS:
    """Gaussian noise proportional to distance and rotation."""

    def __init__(self, settings: LocalizerSettings):
        pass

    def moved(
        self, poses: np.ndarray, base_before: Pose2, base_now: Pose2, rng: np.random.Generator
    ) -> np.ndarray:
        """See amcl_lite.motion.custom_model.MotionModel: particles (N, 3) after the motion."""
        step = base_before.inverse() @ base_now
        distance, turn = np.hypot(step.x, step.y), abs(step.yaw)
        translation, rotation = distance * np.array(PER_METRE) + turn * np.array(PER_RADIAN)
        x, y, yaw = (step.as_array() + rng.normal(0.0, (translation, translation, rotation), poses.shape)).T
        cos, sin = cos_sin(poses[:, 2])
        return poses + np.column_stack((cos * x - sin * y, sin * x + cos * y, yaw))
