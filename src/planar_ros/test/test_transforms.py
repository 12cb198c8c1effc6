"""Unit tests of the transform filter, with jumps back of time."""

from types import SimpleNamespace

import pytest

rospy = pytest.importorskip("rospy")

import tf2_ros  # noqa: E402

from planar import Pose2  # noqa: E402
from planar_ros.messages.conversion import transform_msg  # noqa: E402
from planar_ros.messages.transforms import TransformFilter  # noqa: E402


@pytest.fixture
def buffer():
    return tf2_ros.Buffer(rospy.Duration(10.0), debug=False)


@pytest.fixture
def transform_filter(buffer):
    return TransformFilter(buffer)


def add(transform_filter, parent, child, second, x=0.0, by="simulator"):
    transform_filter.add([transform_msg(Pose2(x, 0.0, 0.0), parent, child, rospy.Time.from_sec(second))], by)


def x_at(buffer, parent, child, second):
    stamp = rospy.Time.from_sec(second)
    return buffer.lookup_transform(parent, child, stamp).transform.translation.x


def test_a_transform_from_before_a_jump_that_arrives_after_it_is_discarded(transform_filter, buffer):
    add(transform_filter, "odom", "base_link", 14.0, x=7.0)
    buffer.clear()  # another listener has detected the jump before tf
    add(transform_filter, "odom", "base_link", 14.1, x=7.0)
    for second in (0.1, 0.2, 0.3):
        add(transform_filter, "odom", "base_link", second, x=second)
    assert x_at(buffer, "odom", "base_link", 0.2) == pytest.approx(0.2)
    latest = buffer.get_latest_common_time("odom", "base_link")
    assert latest.to_sec() == pytest.approx(0.3)


def test_publishers_may_jump_at_different_times(transform_filter, buffer):
    for second in (14.0, 0.1):
        add(transform_filter, "odom", "base_link", second, x=second)
    add(transform_filter, "map", "odom", 14.2, by="amcl")
    for second in (0.2, 0.3):
        add(transform_filter, "map", "odom", second, by="amcl")
        add(transform_filter, "odom", "base_link", second, x=second)
    assert x_at(buffer, "map", "base_link", 0.3) == pytest.approx(0.3)
    assert buffer.get_latest_common_time("map", "base_link").to_sec() == pytest.approx(0.3)


def test_a_publisher_that_lags_behind_another_has_not_jumped(transform_filter, buffer):
    add(transform_filter, "map", "odom", 14.0, by="amcl")
    add(transform_filter, "odom", "base_link", 12.0)
    add(transform_filter, "map", "odom", 13.5, by="amcl")
    assert buffer.get_latest_common_time("map", "base_link").to_sec() == pytest.approx(12.0)


@pytest.mark.parametrize("is_static", [False, True])
@pytest.mark.parametrize(
    "stamp",
    [SimpleNamespace(secs=-1, nsecs=0), rospy.Time(2**31, 5), rospy.Time(2**32 - 1, 999_999_999)],
    ids=str,
)
def test_transforms_with_invalid_stamps_are_ignored(transform_filter, buffer, stamp, is_static):
    """tf2 ends the process if a time difference overflows."""
    add(transform_filter, "odom", "base_link", 1.0)
    bad = transform_msg(Pose2(), "odom", "base_link", stamp)
    transform_filter.add([bad], "simulator", is_static)
    assert buffer.get_latest_common_time("odom", "base_link").to_sec() == pytest.approx(1.0)


def test_static_transforms_are_kept_after_a_jump(transform_filter, buffer):
    static = transform_msg(Pose2(0.1, 0.0, 0.0), "base_link", "laser", rospy.Time.from_sec(14.0))
    transform_filter.add([static], "simulator", is_static=True)
    for second in (14.0, 0.1, 0.2):
        add(transform_filter, "odom", "base_link", second)
    assert x_at(buffer, "odom", "laser", 0.2) == pytest.approx(0.1)
