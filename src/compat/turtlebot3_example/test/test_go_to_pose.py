"""The robot reaches poses, and figures are closed."""

import math

import pytest

from planar import Pose2, wrap
from turtlebot3_example.go_to_pose import (
    MAX_VELOCITY,
    POSITION_TOLERANCE,
    YAW_TOLERANCE,
    figure_corners,
    velocity_to,
)

PERIOD = 0.05


def driven(base_in_odom, goal, align_yaw=True):
    for _ in range(4000):
        velocity = velocity_to(base_in_odom, goal, align_yaw)
        if velocity is None:
            return base_in_odom
        assert abs(velocity.v) <= MAX_VELOCITY.v and abs(velocity.omega) <= MAX_VELOCITY.omega
        turned = Pose2(0.0, 0.0, velocity.omega * PERIOD)
        base_in_odom = base_in_odom @ Pose2(velocity.v * PERIOD, 0.0) @ turned
    raise AssertionError(f"not reached: {base_in_odom}")


@pytest.mark.parametrize("goal", [Pose2(1.0, 0.5, 1.0), Pose2(-1.0, 0.0, 3.1), Pose2(0.0, -0.5, -2.0)])
def test_the_robot_reaches_a_pose_with_its_yaw(goal):
    end = driven(Pose2(0.2, 0.1, -3.0), goal)
    assert end.distance_to(goal) <= POSITION_TOLERANCE + 0.01
    assert abs(wrap(end.yaw - goal.yaw)) < YAW_TOLERANCE


@pytest.mark.parametrize("mode, length", [(1, 4.0), (2, 3.0), (3, math.tau)])
def test_a_figure_is_closed_and_has_the_right_length(mode, length):
    start = Pose2(1.0, 2.0, 0.3)
    corners = figure_corners(start, mode, 1.0)
    assert corners[-1].distance_to(start) < 1e-9
    total = sum(a.distance_to(b) for a, b in zip([start, *corners], corners))
    assert total == pytest.approx(length, rel=0.01)


@pytest.mark.parametrize("mode, size", [(4, 1.0), (1, 0.0), (1, math.nan)])
def test_an_invalid_figure_is_rejected(mode, size):
    with pytest.raises(ValueError, match="there is no figure"):
        figure_corners(Pose2(), mode, size)
