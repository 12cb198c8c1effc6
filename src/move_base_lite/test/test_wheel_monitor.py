"""A stuck wheel is reported; a weak wheel and a robot that drives curves are not."""

import math

import numpy as np
import pytest

from move_base_lite.plausibility.wheel_monitor import RETRY_AFTER, WheelMonitor
from planar import Pose2, Twist2

TRACK, PERIOD = 0.23, 0.02
# Time constant of the drive [s].
LAG = 0.3


class Drive:
    """A differential drive whose wheels turn at a fraction of the commanded speed."""

    def __init__(self, left=1.0, right=1.0, seed=1):
        self.monitor, self._fractions, self._rng = WheelMonitor(), (left, right), np.random.default_rng(seed)
        self.now, self._pose, self._wheels = 0.0, Pose2(), np.zeros(2)

    def go(self, seconds, command):
        """Drive with ``command(now)``; return the first fault, or None."""
        for _ in range(round(seconds / PERIOD)):
            self.now += PERIOD
            commanded = command(self.now)
            targets = commanded.v + np.array([-0.5, 0.5]) * TRACK * commanded.omega
            self._wheels += PERIOD / LAG * (self._fractions * targets - self._wheels)
            left, right = self._wheels + self._rng.normal(0.0, 0.005, 2) * (self._wheels != 0.0)
            self._pose @= Pose2(0.5 * (left + right) * PERIOD, 0.0, (right - left) / TRACK * PERIOD)
            self.monitor.add_odometry(self.now, self._pose, commanded)
            if self.monitor.fault():
                return self.monitor.fault()
        return None


def ahead(_now):
    return Twist2(0.3, 0.0)


def weaving(now):
    return Twist2(0.3 + 0.2 * math.cos(1.3 * now), 1.5 * math.sin(1.1 * now))


def compensating(now):
    """Commands against the rotation caused by a stuck left wheel."""
    return Twist2(0.3, -1.0 + 0.5 * math.sin(now))


def reversing(now):
    return Twist2(-0.2, 0.3 * math.sin(now))


@pytest.mark.parametrize("command", [ahead, weaving, compensating, reversing])
@pytest.mark.parametrize("left, right, side", [(0.0, 1.0, "left"), (1.0, 0.0, "right")])
def test_a_stuck_wheel_is_reported(command, left, right, side):
    assert f"does the {side} wheel turn?" in Drive(left, right).go(15.0, command)


@pytest.mark.parametrize("command", [ahead, weaving, compensating, reversing])
@pytest.mark.parametrize("left, right", [(1.0, 1.0), (0.8, 1.0), (1.0, 0.7)])
def test_turning_wheels_are_not_reported(command, left, right):
    assert Drive(left, right).go(60.0, command) is None


@pytest.mark.parametrize("command", [ahead, weaving])
def test_a_robot_that_is_held_has_no_wheel_fault(command):
    assert Drive(0.0, 0.0).go(30.0, command) is None


def test_a_robot_that_is_rotated_by_hand_has_no_wheel_fault():
    drive = Drive()
    assert drive.go(10.0, ahead) is None
    drive._pose @= Pose2(0.0, 0.0, math.radians(90.0))
    assert drive.go(10.0, ahead) is None


def test_wheels_are_checked_again_after_some_time():
    drive = Drive(0.0, 1.0)
    assert drive.go(15.0, ahead)
    drive._fractions = (1.0, 1.0)
    drive.monitor.add_odometry(drive.now + RETRY_AFTER + 1.0, drive._pose, Twist2())
    drive.now += RETRY_AFTER + 1.0
    assert drive.go(15.0, ahead) is None
