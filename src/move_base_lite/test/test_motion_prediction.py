"""Prediction of the motion during the latency of a command."""

import math

import pytest

from move_base_lite.navigator.motion_prediction import predict_motion
from planar import Pose2, Twist2

ACCELERATION = Twist2(1.5, 4.0)


def test_without_latency_nothing_changes():
    assert predict_motion(Twist2(0.5, 1.0), Twist2(), 0.0, ACCELERATION) == (Pose2(), Twist2(0.5, 1.0))


def test_at_constant_speed_the_robot_moves_along_an_arc():
    moved, twist = predict_motion(Twist2(0.5, 1.0), Twist2(0.5, 1.0), 0.1, ACCELERATION)
    assert twist == Twist2(0.5, 1.0)
    assert moved.yaw == pytest.approx(0.1)
    radius = 0.5
    assert moved.x == pytest.approx(radius * math.sin(0.1), abs=1e-4)
    assert moved.y == pytest.approx(radius * (1.0 - math.cos(0.1)), abs=1e-4)


def test_the_velocity_changes_with_the_limited_acceleration():
    moved, twist = predict_motion(Twist2(), Twist2(0.6, 0.0), 0.1, ACCELERATION)
    assert twist.v == pytest.approx(0.15)
    assert moved.x == pytest.approx(0.5 * 1.5 * 0.1**2)
    assert predict_motion(Twist2(0.1, 0.0), Twist2(), 0.1, ACCELERATION)[1].v == pytest.approx(0.0)
