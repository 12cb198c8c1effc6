"""Odometry of which each step is told wrongly."""

from typing import Optional

from planar import Pose2
from sim_bridge.faults.kind import FaultKind
from sim_bridge.sensors.odometry import Odometry


class DistortedOdometry(FaultKind):
    """Adds its steps up anew, each as ``step`` tells it."""

    _true: Optional[Pose2] = None
    _told = Pose2()

    def odometry(self, odometry: Odometry) -> Optional[Odometry]:
        before, self._true = self._true, odometry.base_in_odom
        if before is None:
            self._told = odometry.base_in_odom
        else:
            self._told = self._told @ self.step(before.inverse() @ odometry.base_in_odom)
        return Odometry(self._told, odometry.twist)

    def step(self, step: Pose2) -> Pose2:
        """What is told of a step of one period."""
        return step
