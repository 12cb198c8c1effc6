"""Checks of the approach along the middle line of a dock."""

import math
from typing import Optional, Tuple

from auto_docking_lite.config import DockingSettings
from auto_docking_lite.contract import DockCode, DockInputs
from auto_docking_lite.motion import LOOKAHEAD, is_free, obstacles_in_base
from planar import Pose2, wrap
from planar.geometry.dock_field import ROBOT_FRONT

# Distance of the front from which lateral and heading errors must be small enough for the contacts [m, rad].
GATE, GATE_ERRORS = 0.12, (0.06, 0.3)
# Time without progress at the dock [s], and distance by which the robot may drive on past it [m].
STALLED, OVERSHOOT = 3.0, 0.06
# Distance that counts as progress, and by which obstacles may be nearer during the approach [m].
MOVED, MARGIN = 0.01, 0.02
# Time without a signal during the approach after which the dock counts as lost [s].
LOST = 4.0


class ApproachMonitor:
    """Checks whether an approach can still succeed; one for each approach.

    Args:
        settings: Geometry of the contacts and of the robot.
    """

    def __init__(self, settings: DockingSettings):
        self._settings = settings
        self._moved_to: Optional[Pose2] = None
        self._signal_at = self._dock_at = self._moved_at = -1.0

    def error(self, inputs: DockInputs, front: Pose2) -> Optional[Tuple[DockCode, str]]:
        """Return why the approach cannot succeed any more; None if it can.

        Args:
            inputs: What is known.
            front: Estimated pose of the robot's front in the dock's frame.
        """
        stamp = inputs.stamp
        if self._signal_at < 0.0 or any(signals[1] for _, signals in inputs.signals):
            self._signal_at = stamp
        if stamp - self._signal_at > LOST:
            return DockCode.FAILED_TO_DETECT_DOCK, "lost the signal of the dock"
        heading = abs(wrap(front.yaw - math.pi))
        if front.x < GATE and (abs(front.y) > GATE_ERRORS[0] or heading > GATE_ERRORS[1]):
            return DockCode.FAILED_TO_CONTROL, "reached the dock beside its contacts"
        if front.x > self._settings.dock_contact_distance or self._dock_at < 0.0:
            self._dock_at = stamp
        if front.x < -OVERSHOOT or stamp - self._dock_at > STALLED:
            return DockCode.FAILED_TO_CHARGE, "reached the dock, but it does not charge"
        return None

    def is_stalled(self, inputs: DockInputs) -> bool:
        """Return whether the robot has not moved for some time although it was commanded to."""
        base = inputs.base_in_odom
        if self._moved_to is None or base.distance_to(self._moved_to) > MOVED:
            self._moved_to, self._moved_at = base, inputs.stamp
        return inputs.stamp - self._moved_at > STALLED

    def pause(self) -> None:
        """Begin to measure progress again, after the robot has waited."""
        self._moved_to = None


def is_approach_free(
    inputs: DockInputs,
    dock_in_odom: Pose2,
    base_in_odom: Pose2,
    settings: DockingSettings,
    margin: float = 0.0,
) -> bool:
    """Return whether nothing but the dock, and what is behind it, hinders the approach from a pose.

    Args:
        inputs: What is known.
        dock_in_odom: Estimated pose of the dock.
        base_in_odom: The pose of the robot.
        settings: Radius of the robot.
        margin: Distance by which obstacles may be nearer [m]: the poses are estimates.
    """
    odom_in_dock = dock_in_odom.inverse()
    obstacles_xy = (odom_in_dock @ inputs.base_in_odom).transform_points(obstacles_in_base(inputs.scan))
    obstacles_xy = obstacles_xy[obstacles_xy[:, 0] > ROBOT_FRONT / 2.0]
    base, radius = odom_in_dock @ base_in_odom, settings.robot_radius - margin
    near, far = (Pose2(max(base.x - factor * LOOKAHEAD, ROBOT_FRONT)) for factor in (1.0, 2.0))
    return is_free(obstacles_xy, base, near, radius) and is_free(obstacles_xy, near, far, radius)
