"""Faults of odometry."""

from typing import Optional

from planar import Pose2
from sim_bridge.faults.kind import FaultKind
from sim_bridge.sensors.odometry import Odometry

# Periods a second at the default rate of odometry.
PERIODS = 50


class StoppedOdometry(FaultKind):
    """Odometry is not published."""

    survivable = False

    def odometry(self, odometry: Odometry) -> Optional[Odometry]:
        return None


class FrozenOdometry(FaultKind):
    """Odometry repeats one pose, as with dead encoders."""

    survivable = False

    _frozen: Optional[Odometry] = None

    def odometry(self, odometry: Odometry) -> Optional[Odometry]:
        self._frozen = self._frozen or odometry
        return self._frozen


class DistortedOdometry(FaultKind):
    """Integrates odometry again from steps that ``step`` has changed."""

    _input: Optional[Pose2] = None
    _output = Pose2()

    def odometry(self, odometry: Odometry) -> Optional[Odometry]:
        before, self._input = self._input, odometry.base_in_odom
        if before is None:
            self._output = odometry.base_in_odom
        else:
            self._output = self._output @ self.step(before.inverse() @ odometry.base_in_odom)
        return Odometry(self._output, odometry.twist)

    def step(self, step: Pose2) -> Pose2:
        """Return the motion that odometry measures in one period.

        Args:
            step: Measured motion without the fault, in the base frame at the beginning of the period.
        """
        return step


class ScaledOdometry(DistortedOdometry):
    """Measured distances are too long or, below 1, too short."""

    strength = (1.1, 0.1, 10.0)
    unit = "times"

    def step(self, step: Pose2) -> Pose2:
        return Pose2(step.x * self._strength, step.y * self._strength, step.yaw)


class SlippingOdometry(DistortedOdometry):
    """Wheels spin now and then, and odometry measures a distance that was not travelled."""

    strength = (0.1, -1.0, 1.0)
    unit = "m each"

    def step(self, step: Pose2) -> Pose2:
        is_moving = abs(step.x) > 1e-4
        spins = is_moving and self._rng.random() < 0.01
        return Pose2(step.x + self._strength * spins, step.y, step.yaw)


class BiasedGyro(DistortedOdometry):
    """The gyro has a bias."""

    strength = (0.05, -1.0, 1.0)
    unit = "rad/s"

    def step(self, step: Pose2) -> Pose2:
        return Pose2(step.x, step.y, step.yaw + self._strength / PERIODS)
