import math

import pytest

from turtlebot3_gazebo.wandering import FORWARD, LEFT_TURN, RIGHT_TURN, Wanderer

FREE = 3.5


@pytest.mark.parametrize(
    ("ahead", "left", "right", "velocity"),
    [
        (FREE, FREE, FREE, FORWARD),
        (0.6, FREE, FREE, RIGHT_TURN),
        (FREE, 0.5, FREE, RIGHT_TURN),
        (FREE, FREE, 0.5, LEFT_TURN),
        (0.6, FREE, 0.5, RIGHT_TURN),
    ],
)
def test_the_robot_drives_where_there_is_clearance(ahead, left, right, velocity):
    assert Wanderer().advance(ahead, left, right, 0.0) == velocity


def test_a_turn_takes_30_degrees_even_across_the_wrap_of_the_yaw():
    wanderer = Wanderer()
    start = math.pi - math.radians(10.0)
    assert wanderer.advance(FREE, FREE, 0.5, start) == LEFT_TURN
    assert wanderer.advance(FREE, FREE, FREE, start + math.radians(20.0) - math.tau) == LEFT_TURN
    assert wanderer.advance(FREE, FREE, FREE, start + math.radians(31.0) - math.tau) == FORWARD
