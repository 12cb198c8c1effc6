"""Playback clock, and snapshots of a recording."""

import math

import pytest
import rosbag
from genpy import Time
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import Float64
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker

from planar_ros.bags.playback_clock import PlaybackClock
from planar_ros.bags.recording import Recording
from planar_ros.bags.snapshot import snapshot_at


def test_delays_follow_the_playback_rate():
    clock = PlaybackClock(start=100.0, end=160.0, speed=2.0, wall=5.0)
    assert clock.delay(104.0, wall=5.0) == pytest.approx(2.0)
    assert clock.delay(104.0, wall=7.0) == pytest.approx(0.0)
    clock.advance_to(104.0)
    clock.set_speed(0.5, wall=7.0)
    assert clock.delay(105.0, wall=7.0) == pytest.approx(2.0)
    clock.set_speed(0.0, wall=8.0)
    assert clock.delay(150.0, wall=8.0) == 0.0


def test_playback_resumes_after_a_pause_without_catching_up():
    clock = PlaybackClock(start=100.0, end=160.0, speed=1.0, wall=0.0)
    clock.advance_to(103.0)
    clock.pause(True, wall=3.0)
    assert clock.delay(103.5, wall=50.0) == math.inf
    clock.pause(False, wall=50.0)
    assert clock.delay(103.5, wall=50.0) == pytest.approx(0.5)


@pytest.mark.parametrize(("wanted", "found"), [(20.0, 120.0), (-3.0, 100.0), (1000.0, 160.0)])
def test_seeking_is_clamped_to_the_recording(wanted, found):
    clock = PlaybackClock(start=100.0, end=160.0, speed=1.0, wall=0.0)
    clock.seek(wanted, wall=9.0)
    assert clock.position == found
    assert clock.delay(found + 1.0, wall=9.0) == pytest.approx(1.0)


def test_a_long_delay_is_not_followed_by_a_burst():
    clock = PlaybackClock(start=0.0, end=60.0, speed=1.0, wall=0.0)
    assert clock.delay(1.0, wall=11.0) == 0.0
    assert clock.delay(2.0, wall=11.0) == pytest.approx(1.0)


@pytest.fixture(name="recording")
def _recording(tmp_path):
    """A number each second, one message at the start, some markers, transforms of two frames."""
    for part, first in enumerate((0, 50)):
        with rosbag.Bag(str(tmp_path / f"{part}.bag"), "w") as bag:
            if first == 0:
                bag.write("/once", Float64(-1.0), Time(100))
            for second in range(first, first + 50):
                at = Time(100 + second)
                bag.write("/number", Float64(second), at)
                frame = ("left", "right")[second % 2]
                bag.write("/tf", TFMessage([TransformStamped(child_frame_id=frame)]), at)
                if second % 20 == 0:
                    bag.write("/marker", Marker(id=second), at)
    return Recording([tmp_path])


def test_a_snapshot_has_the_newest_message_of_each_topic_and_all_markers(recording):
    snapshot = snapshot_at(recording, ["/number", "/once", "/tf", "/marker"], 172.5)
    assert [each.message.data for each in snapshot if each.topic == "/number"] == [72.0]
    assert [each.message.data for each in snapshot if each.topic == "/once"] == [-1.0]
    assert [each.message.id for each in snapshot if each.topic == "/marker"] == [0, 20, 40, 60]
    frames = [each.message.transforms[0].child_frame_id for each in snapshot if each.topic == "/tf"]
    assert set(frames) == {"left", "right"} and len(frames) <= 3
    assert [each.stamp for each in snapshot] == sorted(each.stamp for each in snapshot)


def test_messages_between_two_times(recording):
    numbers = [each.message.data for each in recording.messages(["/number"], since=147.0, until=152.0)]
    assert numbers == [47.0, 48.0, 49.0, 50.0, 51.0, 52.0]


def test_a_type_that_differs_from_the_recorded_one_is_unavailable(tmp_path):
    class Number(Float64):
        _md5sum = "0123456789abcdef0123456789abcdef"

    with rosbag.Bag(str(tmp_path / "one.bag"), "w") as bag:
        bag.write("/old", Number(1.0), Time(1))
        bag.write("/fine", Marker(), Time(2))
    assert Recording([tmp_path]).unavailable_topics == {"/old"}
