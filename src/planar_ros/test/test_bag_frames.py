"""Frames, mountings and message order of bags as other robots record them."""

import math
import random

import pytest
import rosbag
import rospy
from geometry_msgs.msg import Quaternion
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from planar import Pose2
from planar_ros.bags.bag_reader import BagError, BagReader
from planar_ros.bags.scan_log import NoResultError, ScanLog
from planar_ros.messages.conversion import transform_msg

UPSIDE_DOWN = Quaternion(1.0, 0.0, 0.0, 0.0)


class OldTFMessage(TFMessage):
    """tf/tfMessage: the message of /tf before ROS Hydro, with the same definition."""

    _type = "tf/tfMessage"


def upside_down(parent, child, stamp):
    mounting = transform_msg(Pose2(0.1, 0.0, 0.0), parent, child, stamp)
    mounting.transform.rotation = UPSIDE_DOWN
    return mounting


def at(i):
    return rospy.Time.from_sec(100.0 + 0.1 * i)


def write_bag(path, transforms, frame="laser", kind=TFMessage, order=range(20), **options):
    """Write 20 scans; ``transforms(i, stamp)`` returns the transforms on /tf shortly after scan ``i``."""
    with rosbag.Bag(str(path), "w", **options) as bag:
        for i in order:
            scan = LaserScan(Header(0, at(i), frame), -1.0, 1.0, 1.0, 0.0, 0.1, 0.1, 10.0, [1.0] * 3, [])
            bag.write("/scan", scan, at(i))
            moved = transforms(i, at(i))
            if moved:
                bag.write("/tf", kind(moved), at(i) + rospy.Duration(0.008))
    return path


def read(path, odom="odom", base="base_link"):
    """Return the log, its scans and the warnings."""
    warnings = []
    log = ScanLog(path, "/scan", base, odom, warnings.append)
    return log, list(log), warnings


def drive(parent="odom", child="base_link"):
    return lambda i, stamp: [transform_msg(Pose2(0.1 * i, 0.0, 0.0), parent, child, stamp)]


@pytest.mark.parametrize("every", [1, 100], ids=["always", "once"])
def test_the_first_scan_has_the_mounting_that_is_recorded_after_it(tmp_path, every):
    def transforms(i, stamp):
        late = stamp + rospy.Duration(0.008)
        mounting = [upside_down("base_link", "laser", late)] if i % every == 0 else []
        return drive()(i, stamp) + mounting

    _, logged, warnings = read(write_bag(tmp_path / "late.bag", transforms))
    assert warnings == []
    assert [one.scan.upside_down for one in logged] == 20 * [True]
    assert {one.scan.laser_in_base.x for one in logged} == {0.1}


def test_a_mounting_that_comes_seconds_later_is_found(tmp_path):
    def transforms(i, stamp):
        return drive()(i, stamp) + ([upside_down("base_link", "laser", stamp)] if i == 15 else [])

    _, logged, warnings = read(write_bag(tmp_path / "late.bag", transforms))
    assert (warnings, [one.scan.upside_down for one in logged]) == ([], 20 * [True])


def test_a_laser_on_a_turning_mount_is_placed_by_the_stamp_of_each_scan(tmp_path):
    def transforms(i, stamp):
        return drive()(i, stamp) + [transform_msg(Pose2(0.0, 0.0, 0.1 * i), "base_link", "laser", stamp)]

    _, logged, _ = read(write_bag(tmp_path / "turning.bag", transforms))
    assert [one.scan.laser_in_base.yaw for one in logged] == pytest.approx([0.1 * i for i in range(20)])


@pytest.mark.parametrize("child", ["base_footprint", "base_link", "chassis"])
@pytest.mark.parametrize("asked", ["base_link", "base_footprint"])
def test_the_frame_that_moves_in_odom_is_the_base(tmp_path, child, asked):
    def transforms(i, stamp):
        wheel = transform_msg(Pose2(0.0, 0.1, 0.3 * i), "wheels", "wheel_left_link", stamp)
        return [*drive(child=child)(i, stamp), wheel]

    path = write_bag(tmp_path / "frames.bag", transforms)
    log, logged, warnings = read(path, base=asked)
    assert log.frames.base == child
    assert logged[-1].base_in_odom.x == pytest.approx(1.9, abs=0.11)
    substitution = f"{path}: odometry is odom -> {child}, as no transform odom -> {asked} was recorded"
    assert (substitution in warnings) == (child != asked)


def test_odometry_may_have_another_name(tmp_path):
    def transforms(i, stamp):
        return [*drive("odom_combined")(i, stamp), transform_msg(Pose2(), "base_link", "laser", stamp)]

    log, logged, _ = read(write_bag(tmp_path / "frames.bag", transforms))
    assert (log.frames.odom, log.frames.base) == ("odom_combined", "base_link")
    assert logged[-1].base_in_odom.x > 1.5


def test_a_bag_without_odometry_keeps_the_mounting_of_its_laser(tmp_path):
    path = write_bag(tmp_path / "frames.bag", lambda i, stamp: [upside_down("chassis", "laser", stamp)])
    log, logged, warnings = read(path)
    assert (log.frames.base, log.frames.has_odometry) == ("chassis", False)
    assert logged[0].scan.upside_down
    assert f"{path}: the base is chassis, as the bag has no frame base_link" in warnings


def test_several_moving_frames_are_an_error_that_lists_them(tmp_path):
    def transforms(i, stamp):
        return drive("world", "robot_1")(i, stamp) + drive("world", "robot_2")(i, stamp)

    with pytest.raises(BagError, match="world -> robot_1, world -> robot_2"):
        read(write_bag(tmp_path / "two.bag", transforms))


def test_transforms_of_the_old_message_type_are_read(tmp_path):
    path = write_bag(tmp_path / "old.bag", drive(), kind=OldTFMessage)
    _, logged, _ = read(path)
    assert logged[-1].base_in_odom.x == pytest.approx(1.9, abs=0.11)
    assert BagReader(path).unavailable_topics == set()


def test_chunks_out_of_order_are_read_in_the_order_of_time(tmp_path):
    order = list(range(20))
    random.Random(0).shuffle(order)
    path = write_bag(tmp_path / "merged.bag", drive(), order=order, chunk_threshold=1)
    bag = BagReader(path)
    assert (bag.start, bag.end) == pytest.approx((100.0, 101.908))
    stamps = [played.stamp for played in bag.messages(["/scan", "/tf"])]
    assert len(stamps) == 40 and stamps == sorted(stamps)
    assert [played.stamp for played in bag.messages(["/scan"], 100.5, 101.0)] == pytest.approx(
        [100.5, 100.6, 100.7, 100.8, 100.9, 101.0]
    )
    _, logged, warnings = read(path)
    assert [one.base_in_odom.x for one in logged] == pytest.approx([0.1 * i for i in range(20)])
    assert math.isclose(logged[0].position, 0.0) and not [text for text in warnings if "goes back" in text]


def test_a_bag_without_scans_on_the_topic_names_topics_that_have_them(tmp_path):
    path = write_bag(tmp_path / "drive.bag", drive())
    with pytest.raises(NoResultError, match="no scans on /base_scan; .*topics with scans: /scan"):
        ScanLog(path, "/base_scan", "base_link", "odom", print)
