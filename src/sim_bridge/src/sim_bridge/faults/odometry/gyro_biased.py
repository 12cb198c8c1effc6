"""The kind ``gyro_biased``."""

from planar import Pose2
from sim_bridge.faults.odometry.distorted import DistortedOdometry

# A second, of the default rate of odometry.
PERIODS = 50


class BiasedGyro(DistortedOdometry):
    """The gyro turns by itself."""

    strength = (0.05, -1.0, 1.0)
    unit = "rad/s"

    def step(self, step: Pose2) -> Pose2:
        return Pose2(step.x, step.y, step.yaw + self._strength / PERIODS)
