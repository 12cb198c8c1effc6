"""Ideal differential drive (turtlebot3_simulations 1.3)."""

from dataclasses import dataclass
from typing import Tuple

from planar import Pose2, Twist2

WHEEL_RADIUS = 0.033
# Model -> distance between the wheels [m].
TRACKS = {"burger": 0.160, "waffle": 0.287, "waffle_pi": 0.287}
TIMEOUT = 1.0


@dataclass(frozen=True)
class DriveState:
    """State of the drive after a step.

    Attributes:
        base_in_odom: Pose of the robot.
        twist: Velocity of the robot.
        angles: Wheel angles, left and right [rad].
        speeds: Wheel speeds, left and right [rad/s].
    """

    base_in_odom: Pose2
    twist: Twist2
    angles: Tuple[float, float]
    speeds: Tuple[float, float]


class DifferentialDrive:
    """Integrates velocity commands, which expire after TIMEOUT seconds."""

    def __init__(self, model: str, now: float):
        self._track = TRACKS[model]
        self._command, self._commanded_at, self._now = Twist2(), now, now
        self._base_in_odom, self._angles = Pose2(), (0.0, 0.0)

    def command(self, twist: Twist2, now: float) -> None:
        """Set the velocity from ``now`` on [s]."""
        self._command, self._commanded_at = twist, now

    def advance(self, now: float) -> DriveState:
        """Integrate the motion until ``now`` [s]."""
        seconds, self._now = max(0.0, now - self._now), now
        if now - self._commanded_at > TIMEOUT:
            self._command = Twist2()
        v, omega = self._command.v, self._command.omega
        half = omega * self._track / 2.0
        speeds = ((v - half) / WHEEL_RADIUS, (v + half) / WHEEL_RADIUS)
        self._angles = (self._angles[0] + speeds[0] * seconds, self._angles[1] + speeds[1] * seconds)
        middle = self._base_in_odom @ Pose2(0.0, 0.0, omega * seconds / 2.0)
        self._base_in_odom = middle @ Pose2(v * seconds, 0.0, 0.0) @ Pose2(0.0, 0.0, omega * seconds / 2.0)
        return DriveState(self._base_in_odom, self._command, self._angles, speeds)
