import math

import numpy as np
import pytest

from planar import Pose2, wrap
from planar.geometry.pose import cos_sin


def test_inner_frames_of_a_product_cancel():
    odom_in_map = Pose2(1.0, 2.0, math.pi / 2)
    base_in_odom = Pose2(3.0, 0.0, math.pi / 2)
    base_in_map = odom_in_map @ base_in_odom
    assert base_in_map.as_array() == pytest.approx([1.0, 5.0, -math.pi])


def test_a_pose_times_its_inverse_is_the_identity():
    pose = Pose2(0.3, -7.0, 2.2)
    assert (pose @ pose.inverse()).as_array() == pytest.approx([0, 0, 0], abs=1e-12)


def test_points_are_transformed_like_poses():
    pose, other = Pose2(1.0, -2.0, 0.7), Pose2(0.4, 0.9, 0.0)
    moved = pose.transform_points(np.array([[other.x, other.y]]))
    assert moved[0] == pytest.approx((pose @ other).as_array()[:2])


@pytest.mark.parametrize("turns", [-3, -1, 0, 1, 5])
def test_wrapping_removes_whole_turns(turns):
    assert wrap(0.5 + turns * 2 * math.pi) == pytest.approx(0.5)
    assert wrap(np.array([0.5 + turns * 2 * math.pi]))[0] == pytest.approx(0.5)


def test_cosines_have_the_same_bits_wherever_a_column_is_in_memory():
    poses = np.random.default_rng(0).normal(size=(400, 3))
    kept, found = [], set()
    for _ in range(500):
        kept.append(poses.copy())  # results are allocated behind some of these
        found.add(tuple(each.tobytes() for each in cos_sin(kept[-1][:, 2])))
    assert len(found) == 1
