import math

import pytest

rospy = pytest.importorskip("rospy")

from geometry_msgs.msg import Quaternion  # noqa: E402

from planar import Pose2, grid_from_picture  # noqa: E402
from planar_ros.messages import conversion as messages  # noqa: E402


def test_a_pose_survives_the_journey_through_a_message():
    pose = Pose2(1.0, -2.0, 2.5)
    assert messages.pose2_from_msg(messages.pose2_to_msg(pose)).as_array() == pytest.approx(pose.as_array())


@pytest.mark.parametrize("length", [0.01, 1.0, 4.0])
def test_a_quaternion_that_is_not_normalised_still_has_a_yaw(length):
    half = 0.6
    quaternion = Quaternion(0.0, 0.0, length * math.sin(half), length * math.cos(half))
    assert messages.yaw_of(quaternion) == pytest.approx(1.2)


def test_a_grid_survives_the_journey_through_a_message():
    grid = grid_from_picture("#.?\n..#", resolution=0.25, origin=Pose2(1.0, 2.0, 0.5))
    back = messages.grid_from_msg(messages.grid_to_msg(grid, rospy.Time(1), "map"))
    assert back.cells.tolist() == grid.cells.tolist()
    assert (back.resolution, back.origin.yaw) == (grid.resolution, pytest.approx(0.5))


def test_older_codes_leading_slash_is_dropped_from_frames():
    assert messages.frame_name("/map") == messages.frame_name("map") == "map"
