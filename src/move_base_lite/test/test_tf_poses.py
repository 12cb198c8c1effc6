"""Poses of sensors from tf, at the stamps of their data."""

import math

import pytest

rospy = pytest.importorskip("rospy")

import numpy as np  # noqa: E402
import tf2_ros  # noqa: E402

from move_base_lite.ros.sensing.tf_poses import TfPoses  # noqa: E402
from planar import Pose2  # noqa: E402
from planar_ros.messages.conversion import transform_msg  # noqa: E402
from planar_ros.messages.transforms import Transforms  # noqa: E402

# Seconds since 1970, which a float represents to a tenth of a microsecond only.
START = 1796000000


@pytest.fixture
def poses():
    """A robot at 1 m/s whose base is inclined, with a panning laser; its camera is static."""
    transforms = Transforms.__new__(Transforms)
    transforms.buffer = tf2_ros.Buffer(rospy.Duration(10.0), debug=False)
    for tenth in range(11):
        stamp = rospy.Time(START, 100_000_000 * tenth) if tenth < 10 else rospy.Time(START + 1)
        base = transform_msg(Pose2(0.1 * tenth), "odom", "base_footprint", stamp)
        base.transform.translation.z = 0.2
        base.transform.rotation.y, base.transform.rotation.w = math.sin(0.1), math.cos(0.1)
        laser = transform_msg(Pose2(0.1, 0.0, 0.2 * tenth), "base_footprint", "laser", stamp)
        for transform in (base, laser):
            transforms.buffer.set_transform(transform, "test")
    camera = transform_msg(Pose2(0.0, 0.3), "base_footprint", "camera", rospy.Time(START))
    transforms.buffer.set_transform_static(camera, "test")
    return TfPoses(transforms, "map", "odom", "base_footprint")


def yaw_of(matrix):
    return math.atan2(matrix[1, 0], matrix[0, 0])


@pytest.mark.parametrize("seconds", [0.0, 0.33, 0.7, 1.0])
def test_a_panning_laser_has_the_pose_of_the_stamp(poses, seconds):
    laser_in_base = poses.frame_in_base("laser", START + seconds)
    assert yaw_of(laser_in_base) == pytest.approx(2.0 * seconds, abs=1e-3)
    assert laser_in_base[:3, 3] == pytest.approx([0.1, 0.0, 0.0])


def test_the_base_keeps_height_and_inclination(poses):
    base_in_odom = poses.base_in_space(START + 0.5)
    assert base_in_odom[:3, 3] == pytest.approx([0.5, 0.0, 0.2], abs=1e-6)
    assert math.asin(-base_in_odom[2, 0]) == pytest.approx(0.2)


def test_static_frames_are_known_at_any_stamp(poses):
    assert poses.frame_in_base("camera", START + 100.0)[1, 3] == pytest.approx(0.3)


def test_a_fixed_frame_has_a_pose_in_the_base_too(poses):
    odom_in_base = poses.frame_in_base("odom", START + 0.5)
    assert odom_in_base @ poses.base_in_space(START + 0.5) == pytest.approx(np.eye(4), abs=1e-6)


def test_nothing_is_known_beyond_the_latest_transform(poses):
    assert poses.frame_in_base("laser", START + 1.1) is None
    assert poses.base_in_space(START + 1.1) is None
    assert poses.frame_in_base("sonar", START + 0.5) is None


def test_the_missing_transform_is_described(poses):
    text = poses.missing_transform(["camera", "sonar"], START + 0.5)
    assert text.startswith("no transform base_footprint -> sonar at their stamps; is it published? (")
    assert "sonar" in text.partition("(")[2]
    assert "into the future" in poses.missing_transform(["laser"], START + 1.5)
