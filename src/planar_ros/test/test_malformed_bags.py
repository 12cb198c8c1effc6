"""Bags with invalid messages, stamps or bytes."""

import math

import pytest
import rosbag
import rospy
from genpy import Time
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from planar import Pose2
from planar_ros.bags.bag_reader import BagError
from planar_ros.bags.scan_log import ScanLog
from planar_ros.messages.conversion import transform_msg

NEVER = Time(2**32 - 1, 999_999_999)


def log_of(path, warn=lambda text: None):
    return ScanLog(path, "/scan", "base_link", "odom", warn)


def test_messages_with_overflowing_stamps_are_skipped(tmp_path):
    """tf2 ends the process for such stamps."""
    path, warnings = tmp_path / "late.bag", []
    with rosbag.Bag(str(path), "w") as bag:
        for i, stamp in enumerate([Time(100), NEVER, Time(2**31, 5), Time(101), Time(102)]):
            at = rospy.Time(100 + i)
            bag.write("/tf", TFMessage([transform_msg(Pose2(), "odom", "base_link", stamp)]), at)
            bag.write("/tf_static", TFMessage([transform_msg(Pose2(), "base_link", "laser", NEVER)]), at)
            scan = LaserScan(ranges=[1.0] * 3, range_max=10.0)
            scan.header.stamp = stamp
            bag.write("/scan", scan, at)
    assert len(list(log_of(path, warnings.append))) == 3
    assert [text for text in warnings if "its stamp is out of range" in text]


@pytest.mark.parametrize("direction", ["angle_increment", "angle_min"])
def test_a_scan_with_nan_angles_is_skipped_with_a_warning(tmp_path, direction):
    path, warnings = tmp_path / "nowhere.bag", []
    with rosbag.Bag(str(path), "w") as bag:
        for i in range(3):
            scan = LaserScan(ranges=[1.0] * 3, range_max=10.0)
            scan.header.stamp = Time(100 + i)
            if i == 1:
                setattr(scan, direction, math.nan)
            bag.write("/scan", scan, scan.header.stamp)
    assert [one.scan.stamp for one in log_of(path, warnings.append)] == [100.0, 102.0]
    warning = f"{path}: skipping a scan (a scan with invalid {direction} nan), at stamp 101.000"
    assert any(text.startswith(warning) for text in warnings)


@pytest.mark.parametrize("topic", ["/scan", "/tf", "/tf_static"])
def test_an_error_names_the_topic_with_the_wrong_type(tmp_path, topic):
    path = tmp_path / "texts.bag"
    with rosbag.Bag(str(path), "w") as bag:
        bag.write("/scan", LaserScan() if topic != "/scan" else String("no scan"), Time(1))
        bag.write(topic, String("no"), Time(2))
    with pytest.raises(BagError, match=f"the messages on {topic} are"):
        log_of(path)


def test_a_bag_with_broken_bytes_is_rejected_or_read_up_to_the_error(tmp_path):
    path = tmp_path / "whole.bag"
    with rosbag.Bag(str(path), "w") as bag:
        for i in range(5):
            bag.write("/scan", LaserScan(ranges=[1.0] * 3, range_max=10.0), Time(1 + i))
    content = path.read_bytes()
    for at in range(13, len(content), 7):
        broken = bytearray(content)
        broken[at] ^= 0xFF
        path.write_bytes(bytes(broken))
        try:
            list(log_of(path))
        except BagError as error:
            assert "whole.bag" in str(error)
