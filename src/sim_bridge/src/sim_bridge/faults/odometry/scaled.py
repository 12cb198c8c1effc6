"""The kind ``odometry_scaled``."""

from planar import Pose2
from sim_bridge.faults.odometry.distorted import DistortedOdometry


class ScaledOdometry(DistortedOdometry):
    """Odometry tells distances too long, or, less than 1, too short."""

    strength = (1.1, 0.1, 10.0)
    unit = "times"

    def step(self, step: Pose2) -> Pose2:
        return Pose2(step.x * self._strength, step.y * self._strength, step.yaw)
