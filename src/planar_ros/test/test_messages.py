import math

import pytest

rospy = pytest.importorskip("rospy")

from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3  # noqa: E402
from nav_msgs.msg import OccupancyGrid  # noqa: E402
from sensor_msgs.msg import LaserScan  # noqa: E402

from planar import PlanarError, Pose2, grid_from_picture  # noqa: E402
from planar.geometry.limits import MAX_COORDINATE  # noqa: E402
from planar_ros.messages import conversion as messages  # noqa: E402


def test_a_pose_is_unchanged_by_conversion_to_a_message_and_back():
    pose = Pose2(1.0, -2.0, 2.5)
    assert messages.pose2_from_msg(messages.pose2_to_msg(pose)).as_array() == pytest.approx(pose.as_array())


@pytest.mark.parametrize("length", [0.01, 1.0, 4.0])
def test_yaw_of_a_quaternion_that_is_not_normalized(length):
    half = 0.6
    quaternion = Quaternion(0.0, 0.0, length * math.sin(half), length * math.cos(half))
    assert messages.yaw_of(quaternion) == pytest.approx(1.2)


def test_a_grid_is_unchanged_by_conversion_to_a_message_and_back():
    grid = grid_from_picture("#.?\n..#", resolution=0.25, origin=Pose2(1.0, 2.0, 0.5))
    back = messages.grid_from_msg(messages.grid_to_msg(grid, rospy.Time(1), "map"))
    assert back.cells.tolist() == grid.cells.tolist()
    assert (back.resolution, back.origin.yaw) == (grid.resolution, pytest.approx(0.5))


def test_a_leading_slash_is_removed_from_frame_names():
    assert messages.frame_name("/map") == messages.frame_name("map") == "map"


def laser_scan(**changed):
    message = LaserScan(angle_min=-1.0, angle_increment=0.5, range_min=0.1, range_max=5.0, ranges=[1.0] * 5)
    for name, value in changed.items():
        setattr(message, name, value)
    return message


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e300])
@pytest.mark.parametrize("name", ["angle_min", "angle_increment", "range_min"])
def test_a_scan_message_with_invalid_numbers_is_rejected(name, value):
    with pytest.raises(PlanarError, match=name):
        messages.scan_from_msg(laser_scan(**{name: value}), Pose2())


def test_an_infinite_range_max_is_limited():
    assert messages.scan_from_msg(laser_scan(range_max=math.inf), Pose2()).range_max == MAX_COORDINATE


@pytest.mark.parametrize("size", [(3, 2), (0, 5), (2**32 - 1, 2**32 - 1)])
def test_a_map_message_with_data_of_the_wrong_length_is_rejected(size):
    message = OccupancyGrid()
    message.info.resolution, message.info.width, message.info.height = 0.05, *size
    message.data = [0] * 5
    with pytest.raises(PlanarError, match="cells with 5 values"):
        messages.grid_from_msg(message)


@pytest.mark.parametrize("x", [math.nan, math.inf, 1e18, -1e300])
def test_a_pose_message_out_of_range_is_rejected(x):
    with pytest.raises(messages.MessageError):
        messages.pose2_from_msg(Pose(position=Point(x, 0.0, 0.0)))


@pytest.mark.parametrize("omega", [math.nan, 1e308])
def test_a_velocity_out_of_range_is_rejected(omega):
    with pytest.raises(messages.MessageError):
        messages.twist2_from_msg(Twist(angular=Vector3(0.0, 0.0, omega)))
