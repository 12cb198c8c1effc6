import math

import pytest

from planar import Pose2, Twist2
from turtlebot3_fake.differential_drive import TRACKS, WHEEL_RADIUS, DifferentialDrive


def driven(twist, seconds, model="burger"):
    drive = DifferentialDrive(model, 0.0)
    for step in range(1, round(seconds * 30) + 1):
        drive.command(twist, step / 30.0)
        state = drive.advance(step / 30.0)
    return state


def test_a_straight_motion_has_the_commanded_length():
    state = driven(Twist2(0.2, 0.0), 3.0)
    assert state.base_in_odom.distance_to(Pose2(0.6, 0.0)) < 1e-9
    assert state.angles == pytest.approx((0.6 / WHEEL_RADIUS,) * 2)


@pytest.mark.parametrize("model", TRACKS)
def test_a_circle_is_closed(model):
    state = driven(Twist2(0.5 / 3.0, math.tau / 3.0), 3.0, model)
    assert state.base_in_odom.distance_to(Pose2()) < 1e-6
    left, right = state.angles
    assert (right - left) * WHEEL_RADIUS == pytest.approx(math.tau * TRACKS[model])


def test_a_command_expires_after_a_second():
    drive = DifferentialDrive("burger", 0.0)
    drive.command(Twist2(0.1, 0.0), 0.0)
    assert drive.advance(0.9).twist.v == 0.1
    assert drive.advance(1.1).twist.v == 0.0
