"""The kind ``odometry_slipping``."""

from planar import Pose2
from sim_bridge.faults.odometry.distorted import DistortedOdometry


class SlippingOdometry(DistortedOdometry):
    """Now and then the wheels spin, and odometry tells of a way that is none."""

    strength = (0.1, -1.0, 1.0)
    unit = "m each"

    def step(self, step: Pose2) -> Pose2:
        is_moving = abs(step.x) > 1e-4
        spins = is_moving and self._rng.random() < 0.01
        return Pose2(step.x + self._strength * spins, step.y, step.yaw)
