import pytest
import rosbag
import rospy
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from planar import Pose2
from planar_ros.bags.scan_log import ScanLog
from planar_ros.messages.conversion import transform_msg

LASER_IN_BASE = Pose2(0.1, 0.0, 0.0)


def write_bag(path, static):
    """Write 20 scans of a robot at 1 m/s; ``static``: mounting pose of the laser by number of the scan."""
    with rosbag.Bag(str(path), "w") as bag:
        for i in range(20):
            stamp = rospy.Time.from_sec(100.0 + 0.1 * i)
            base_in_odom = transform_msg(Pose2(0.1 * i, 0.0), "odom", "base_link", stamp)
            bag.write("/tf", TFMessage([base_in_odom]), stamp)
            scan = LaserScan(ranges=[1.0] * 3, range_max=10.0)
            scan.header.frame_id, scan.header.stamp = "laser", stamp
            bag.write("/scan", scan, stamp)
            if i in static:
                laser = transform_msg(static[i], "base_link", "laser", stamp)
                bag.write("/tf_static", TFMessage([laser]), stamp)
    return path


@pytest.mark.parametrize("static_at", [[0], [15], [3, 9, 15]], ids=["first", "late", "repeated"])
def test_static_transforms_hold_from_the_start_wherever_they_are_in_the_bag(tmp_path, static_at):
    warnings = []
    bag = write_bag(tmp_path / "late.bag", dict.fromkeys(static_at, LASER_IN_BASE))
    log = ScanLog(bag, "/scan", "base_link", "odom", warnings.append)
    logged = list(log)
    assert warnings == []
    assert [one.scan.laser_in_base for one in logged] == 20 * [LASER_IN_BASE]
    assert [one.base_in_odom.x for one in logged] == pytest.approx([0.1 * i for i in range(20)])


def test_a_warning_names_contradicting_static_transforms(tmp_path):
    warnings, moved = [], Pose2(0.3, 0.0, 0.0)
    bag = write_bag(tmp_path / "moved.bag", {0: LASER_IN_BASE, 5: LASER_IN_BASE, 10: moved, 15: moved})
    logged = list(ScanLog(bag, "/scan", "base_link", "odom", warnings.append))
    assert warnings == [
        f"{bag}: /tf_static contradicts itself about base_link -> laser (using the later one from here on), "
        "at stamp 101.000, 53 % into the bag"
    ]
    assert [one.scan.laser_in_base for one in logged] == 11 * [LASER_IN_BASE] + 9 * [moved]


def test_a_turning_mount_holds_at_the_stamp_of_each_scan(tmp_path):
    """The transforms of a nodding or panning laser are recorded after the scans that they belong to."""
    path = tmp_path / "turning.bag"
    with rosbag.Bag(str(path), "w") as bag:
        for i in range(20):
            stamp = rospy.Time.from_sec(100.0 + 0.1 * i)
            scan = LaserScan(ranges=[1.0] * 3, range_max=10.0)
            scan.header.frame_id, scan.header.stamp = "laser", stamp
            bag.write("/scan", scan, stamp)
            transforms = [
                transform_msg(Pose2(), "odom", "base_link", stamp),
                transform_msg(Pose2(0.0, 0.0, 0.1 * i), "base_link", "laser", stamp),
            ]
            for later, transform in enumerate(transforms, 1):
                bag.write("/tf", TFMessage([transform]), stamp + rospy.Duration(0.02 * later))
    warnings = []
    logged = list(ScanLog(path, "/scan", "base_link", "odom", warnings.append))
    yaws = [one.scan.laser_in_base.yaw for one in logged]
    assert yaws == pytest.approx([0.1 * i for i in range(20)])
    assert not warnings
