"""Each scan is placed where its laser was at its stamp, not where it is now."""

import pytest

rospy = pytest.importorskip("rospy")

from planar import Pose2  # noqa: E402
from planar_ros.messages.conversion import LaserScanArrays  # noqa: E402
from planar_ros.messages.newest_scan import WAITING_SCANS, NewestScan  # noqa: E402

TURN_RATE = 0.5


class TurningMount:
    """A laser that turns with constant speed; its transforms are known up to ``until`` [s]."""

    until = 0.0

    def mounting(self, base_frame, sensor_frame, stamp=None):
        time = self.until if stamp is None else stamp.to_sec()
        known = time <= self.until and (base_frame, sensor_frame) == ("base", "laser")
        return (Pose2(0.0, 0.0, TURN_RATE * time), False) if known else None


@pytest.fixture
def mount():
    return TurningMount()


@pytest.fixture
def scans(mount):
    return NewestScan(mount, "base")


def scan(stamp):
    message = LaserScanArrays(angle_increment=0.1, range_min=0.1, range_max=5.0, ranges=[1.0, 2.0])
    message.header.stamp, message.header.frame_id = rospy.Time.from_sec(stamp), "/laser"
    return message


def test_a_scan_keeps_the_mounting_of_its_stamp(scans, mount):
    mount.until = 3.0
    scans.add(scan(1.0), 1.1)
    placed, received = scans.latest()
    assert (placed.laser_in_base.yaw, received) == (TURN_RATE * 1.0, 1.1)


def test_a_scan_waits_for_the_transform_of_its_stamp(scans, mount):
    mount.until = 1.0
    scans.add(scan(1.0), 1.0)
    scans.add(scan(2.0), 2.0)
    assert scans.latest()[1] == 1.0
    assert scans.missing() == "base -> laser at 2.000"
    mount.until = 2.0
    assert scans.latest()[0].laser_in_base.yaw == TURN_RATE * 2.0
    assert scans.missing() == ""


def test_of_scans_with_known_transforms_the_newest_counts(scans, mount):
    mount.until = 2.5
    for stamp in (1.0, 2.0, 3.0):
        scans.add(scan(stamp), stamp)
    assert scans.latest()[1] == 2.0
    mount.until = 3.0
    assert scans.latest()[1] == 3.0


def test_scans_without_transforms_are_dropped_after_some(scans, mount):
    for stamp in range(1, WAITING_SCANS + 2):
        scans.add(scan(float(stamp)), float(stamp))
    mount.until = 1.0
    assert scans.latest() is None
    scans.clear()
    assert scans.missing() == ""
