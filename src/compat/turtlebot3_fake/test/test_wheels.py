import math

import pytest

from planar import Pose2, Twist2
from turtlebot3_fake.wheels import TRACKS, WHEEL_RADIUS, Wheels


def driven(twist, seconds, model="burger"):
    wheels = Wheels(model, 0.0)
    for step in range(1, round(seconds * 30) + 1):
        wheels.command(twist, step / 30.0)
        motion = wheels.advance(step / 30.0)
    return motion


def test_it_goes_straight_as_far_as_it_is_told():
    motion = driven(Twist2(0.2, 0.0), 3.0)
    assert motion.base_in_odom.distance_to(Pose2(0.6, 0.0)) < 1e-9
    assert motion.angles == pytest.approx((0.6 / WHEEL_RADIUS,) * 2)


@pytest.mark.parametrize("model", TRACKS)
def test_it_comes_round_a_circle(model):
    motion = driven(Twist2(0.5 / 3.0, math.tau / 3.0), 3.0, model)
    assert motion.base_in_odom.distance_to(Pose2()) < 1e-6
    left, right = motion.angles
    assert (right - left) * WHEEL_RADIUS == pytest.approx(math.tau * TRACKS[model])


def test_it_stops_a_second_after_the_last_command():
    wheels = Wheels("burger", 0.0)
    wheels.command(Twist2(0.1, 0.0), 0.0)
    assert wheels.advance(0.9).twist.v == 0.1
    assert wheels.advance(1.1).twist.v == 0.0
