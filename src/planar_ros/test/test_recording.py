import pytest
import rosbag
import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

from planar_ros.bags.bag_reader import LASER_SCAN, BagError
from planar_ros.bags.recording import Recording, bag_paths


def write_bag(path, start, count, chunk_bytes=4000):
    with rosbag.Bag(str(path), "w", chunk_threshold=chunk_bytes) as bag:
        for i in range(count):
            stamp = rospy.Time.from_sec(start + 0.1 * i)
            bag.write("/scan", LaserScan(ranges=[1.0] * 100), stamp)
            bag.write("/odom", Odometry(), stamp)
    return path


def test_the_bags_of_a_recording_are_read_in_time_order(tmp_path):
    write_bag(tmp_path / "b.bag", 1.0, 5)
    write_bag(tmp_path / "a.bag", 11.0, 5)
    recording = Recording([tmp_path])
    stamps = [played.stamp for played in recording.messages({"/scan", "/odom"})]
    assert stamps == sorted(stamps)
    assert len(stamps) == 20
    assert (recording.start, recording.end) == (1.0, 11.4)
    assert recording.topics_of(LASER_SCAN) == ["/scan"]
    assert recording.truncations == []


def test_a_truncated_bag_is_read_up_to_its_end_and_not_modified(tmp_path):
    path = write_bag(tmp_path / "cut.bag.active", 1.0, 200)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    before = path.read_bytes()
    recording = Recording([tmp_path])
    played = list(recording.messages({"/scan"}))
    print(f"{len(played)} of 200 scans, {recording.truncations}")
    assert 50 < len(played) < 150
    assert recording.truncations[0].startswith("cut.bag.active: cut off ")
    assert path.read_bytes() == before


def test_an_error_names_the_path_without_messages(tmp_path):
    with pytest.raises(BagError, match="none.bag: no such bag"):
        bag_paths([tmp_path / "none.bag"])
    with pytest.raises(BagError, match="no bag in this folder"):
        bag_paths([tmp_path])
    with pytest.raises(BagError, match="empty.bag: the bag has no messages"):
        Recording([write_bag(tmp_path / "empty.bag", 0.0, 0)])
    (tmp_path / "text.bag").write_text("no bag")
    with pytest.raises(BagError, match="text.bag: not a readable bag"):
        Recording([tmp_path / "text.bag"])
    cut = write_bag(tmp_path / "cut.bag", 1.0, 100)
    cut.write_bytes(cut.read_bytes()[:4200])
    with pytest.raises(BagError, match="cut.bag: cut off before the first complete chunk"):
        Recording([cut])


def test_an_error_names_the_broken_one_of_several_bags(tmp_path):
    """Also if the bags are not given in time order."""
    early, late = (
        write_bag(tmp_path / "early.bag", 1.0, 5),
        write_bag(tmp_path / "late.bag", 11.0, 200, 10**6),
    )
    content = bytearray(late.read_bytes())
    middle = len(content) // 2
    content[middle : middle + 8000] = b"\xff" * 8000
    late.write_bytes(content)
    with pytest.raises(BagError, match=r"late\.bag: broken"):
        list(Recording([late, early]).messages({"/scan"}))
