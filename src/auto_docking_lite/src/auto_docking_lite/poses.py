"""Poses of a robot before and in a dock."""

import math

from auto_docking_lite.config import DockingSettings
from planar import Pose2
from planar.geometry.dock_field import ROBOT_FRONT


def pose_when_docked(dock: Pose2) -> Pose2:
    """Return the pose of a docked robot's base, in the frame of the dock's pose."""
    return dock @ Pose2(ROBOT_FRONT, 0.0, math.pi)


def staging_pose(
    dock: Pose2, settings: DockingSettings = DockingSettings(), bearing: float = 0.0, factor: float = 1.0
) -> Pose2:
    """Return the pose from which a robot approaches a dock, facing it.

    Args:
        dock: Pose of the dock.
        settings: ``staging_distance``.
        bearing: Angle between the dock's middle line and the direction to the pose [rad].
        factor: Factor of the distance.
    """
    return dock @ Pose2(0.0, 0.0, bearing) @ Pose2(factor * settings.staging_distance, 0.0, math.pi)
