"""A wheel that stands is named, and one that is only weak, or a robot that takes curves, is not."""

import math

import numpy as np
import pytest

from move_base_lite.plausibility.wheel_monitor import RETRY_AFTER, WheelMonitor
from planar import Pose2, Twist2

TRACK, PERIOD = 0.23, 0.02
# Seconds that a drive takes to follow.
LAG = 0.3


class Drive:
    """A differential drive whose wheels turn by shares of what they are told."""

    def __init__(self, left=1.0, right=1.0, seed=1):
        self.watch, self._shares, self._rng = WheelMonitor(), (left, right), np.random.default_rng(seed)
        self.now, self._pose, self._wheels = 0.0, Pose2(), np.zeros(2)

    def go(self, seconds, command):
        """The first complaint while the robot is told what ``command`` returns for each time, or None."""
        for _ in range(round(seconds / PERIOD)):
            self.now += PERIOD
            told = command(self.now)
            wanted = told.v + np.array([-0.5, 0.5]) * TRACK * told.omega
            self._wheels += PERIOD / LAG * (self._shares * wanted - self._wheels)
            left, right = self._wheels + self._rng.normal(0.0, 0.005, 2) * (self._wheels != 0.0)
            self._pose @= Pose2(0.5 * (left + right) * PERIOD, 0.0, (right - left) / TRACK * PERIOD)
            self.watch.add_odometry(self.now, self._pose, told)
            if self.watch.fault():
                return self.watch.fault()
        return None


def ahead(_now):
    return Twist2(0.3, 0.0)


def weaving(now):
    return Twist2(0.3 + 0.2 * math.cos(1.3 * now), 1.5 * math.sin(1.1 * now))


def fighting(now):
    """Told to turn against the turn that a standing left wheel makes."""
    return Twist2(0.3, -1.0 + 0.5 * math.sin(now))


def reversing(now):
    return Twist2(-0.2, 0.3 * math.sin(now))


@pytest.mark.parametrize("command", [ahead, weaving, fighting, reversing])
@pytest.mark.parametrize("left, right, side", [(0.0, 1.0, "left"), (1.0, 0.0, "right")])
def test_a_wheel_that_stands_is_named(command, left, right, side):
    assert f"does the {side} wheel turn?" in Drive(left, right).go(15.0, command)


@pytest.mark.parametrize("command", [ahead, weaving, fighting, reversing])
@pytest.mark.parametrize("left, right", [(1.0, 1.0), (0.8, 1.0), (1.0, 0.7)])
def test_wheels_that_turn_are_not(command, left, right):
    assert Drive(left, right).go(60.0, command) is None


@pytest.mark.parametrize("command", [ahead, weaving])
def test_a_robot_that_is_held_tells_nothing(command):
    assert Drive(0.0, 0.0).go(30.0, command) is None


def test_a_robot_that_is_turned_round_by_hand_has_wheels():
    drive = Drive()
    assert drive.go(10.0, ahead) is None
    drive._pose @= Pose2(0.0, 0.0, math.radians(90.0))
    assert drive.go(10.0, ahead) is None


def test_it_is_tried_again_after_a_rest():
    drive = Drive(0.0, 1.0)
    assert drive.go(15.0, ahead)
    drive._shares = (1.0, 1.0)
    drive.watch.add_odometry(drive.now + RETRY_AFTER + 1.0, drive._pose, Twist2())
    drive.now += RETRY_AFTER + 1.0
    assert drive.go(15.0, ahead) is None
