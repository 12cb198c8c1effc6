"""Where in a recording one is, and what stands there."""

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


def test_it_moves_at_its_pace():
    head = PlaybackClock(start=100.0, end=160.0, speed=2.0, wall=5.0)
    assert head.delay(104.0, wall=5.0) == pytest.approx(2.0)
    assert head.delay(104.0, wall=7.0) == pytest.approx(0.0)
    head.advance_to(104.0)
    head.set_speed(0.5, wall=7.0)
    assert head.delay(105.0, wall=7.0) == pytest.approx(2.0)
    head.set_speed(0.0, wall=8.0)
    assert head.delay(150.0, wall=8.0) == 0.0


def test_a_pause_costs_nothing_of_what_comes_after():
    head = PlaybackClock(start=100.0, end=160.0, speed=1.0, wall=0.0)
    head.advance_to(103.0)
    head.pause(True, wall=3.0)
    assert head.delay(103.5, wall=50.0) == math.inf
    head.pause(False, wall=50.0)
    assert head.delay(103.5, wall=50.0) == pytest.approx(0.5)


@pytest.mark.parametrize(("wanted", "found"), [(20.0, 120.0), (-3.0, 100.0), (1000.0, 160.0)])
def test_one_jumps_to_places_that_there_are(wanted, found):
    head = PlaybackClock(start=100.0, end=160.0, speed=1.0, wall=0.0)
    head.seek(wanted, wall=9.0)
    assert head.position == found
    assert head.delay(found + 1.0, wall=9.0) == pytest.approx(1.0)


def test_delays_are_not_made_up_for_in_a_burst():
    head = PlaybackClock(start=0.0, end=60.0, speed=1.0, wall=0.0)
    assert head.delay(1.0, wall=11.0) == 0.0
    assert head.delay(2.0, wall=11.0) == pytest.approx(1.0)


@pytest.fixture(name="recording")
def _recording(tmp_path):
    """A number a second, one word at the start, a marker now and then, transforms of two frames."""
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


def test_what_stands_is_the_newest_of_each_and_all_markers(recording):
    standing = snapshot_at(recording, ["/number", "/once", "/tf", "/marker"], 172.5)
    assert [each.message.data for each in standing if each.topic == "/number"] == [72.0]
    assert [each.message.data for each in standing if each.topic == "/once"] == [-1.0]
    assert [each.message.id for each in standing if each.topic == "/marker"] == [0, 20, 40, 60]
    frames = [each.message.transforms[0].child_frame_id for each in standing if each.topic == "/tf"]
    assert set(frames) == {"left", "right"} and len(frames) <= 3
    assert [each.stamp for each in standing] == sorted(each.stamp for each in standing)


def test_messages_between_two_moments(recording):
    numbers = [each.message.data for each in recording.messages(["/number"], since=147.0, until=152.0)]
    assert numbers == [47.0, 48.0, 49.0, 50.0, 51.0, 52.0]


def test_a_type_that_is_not_as_it_was_recorded_is_told(tmp_path):
    class Number(Float64):
        _md5sum = "0123456789abcdef0123456789abcdef"

    with rosbag.Bag(str(tmp_path / "one.bag"), "w") as bag:
        bag.write("/old", Number(1.0), Time(1))
        bag.write("/fine", Marker(), Time(2))
    assert Recording([tmp_path]).unavailable_topics == {"/old"}
