"""Backing off from what the robot has touched."""

from typing import Optional

from auto_docking_lite.config import DockingSettings
from auto_docking_lite.contract import DockInputs
from auto_docking_lite.motion import is_free, obstacles_in_base
from planar import Pose2, Twist2

# Distance by which the robot backs off, and its speed [m, m/s].
BACKING, BACKING_SPEED = 0.3, 0.15


class BackingOff:
    """Drives back a little, as far as nothing is behind; for one bump.

    Args:
        inputs: What is known when it begins.
        settings: Radius of the robot.
    """

    def __init__(self, inputs: DockInputs, settings: DockingSettings):
        self._settings, self._started = settings, inputs.stamp
        self._end = inputs.base_in_odom @ Pose2(-BACKING)

    def command(self, inputs: DockInputs) -> Optional[Twist2]:
        """Return the next command; None at the end."""
        remaining = (self._end.inverse() @ inputs.base_in_odom).x
        is_late = inputs.stamp - self._started > 2.0 * BACKING / BACKING_SPEED
        behind = obstacles_in_base(inputs.scan)
        if (
            remaining <= 0.0
            or is_late
            or not is_free(behind, Pose2(), Pose2(-0.05), self._settings.robot_radius)
        ):
            return None
        return Twist2(-BACKING_SPEED)
