"""Where frames are."""

import numpy as np
import pytest

from cockpit.frames import FrameTree, Transform, inverse, pose_matrix, wxyz_of


def tree(**parents):
    frames = FrameTree()
    for number, (child, parent) in enumerate(parents.items(), 1):
        pose = pose_matrix((float(number), 0.0, 0.0), (0.0, 0.0, 1.0, 1.0))
        frames.put(child, Transform(parent, pose, 0.0, False))
    return frames


def test_a_pose_is_the_chain_of_those_between():
    frames = tree(odom="map", base="odom", laser="base")
    pose = frames.pose("laser", "map")
    assert np.allclose(pose[:3, 3], [1.0 + 0.0 - 3.0, 2.0, 0.0])
    assert np.allclose(frames.pose("map", "laser"), inverse(pose))


def test_frames_that_no_chain_joins_have_no_pose():
    frames = tree(odom="map", base="world")
    assert frames.pose("base", "map") is None
    assert frames.pose("nowhere", "map") is None
    assert frames.roots() == ["map", "world"]


def test_a_loop_of_frames_ends():
    assert tree(a="b", b="a").pose("a", "map") is None


def test_a_pose_that_is_none_is_known():
    assert pose_matrix((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)) is None
    assert pose_matrix((np.nan, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)) is None
    assert pose_matrix((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, np.inf)) is None


def test_what_was_seen_a_moment_ago_is_where_its_frame_was_then():
    frames = FrameTree()
    for stamp in (1.0, 1.1, 1.2):
        frames.put("laser", Transform("map", pose_matrix((stamp, 0, 0), (0, 0, 0, 1)), stamp, False))
    assert [frames.pose("laser", "map", at)[0, 3] for at in (0.0, 1.11, 9.0, None)] == [1.0, 1.1, 1.2, 1.2]
    frames.put("laser", Transform("map", pose_matrix((0.1, 0, 0), (0, 0, 0, 1)), 0.1, False))
    assert frames.pose("laser", "map", 1.2)[0, 3] == 0.1


def test_a_rotation_and_its_quaternion_are_each_other():
    rng = np.random.default_rng(7)
    for w, x, y, z in [*np.eye(4), *-np.eye(4), *rng.normal(size=(100, 4))]:
        pose = pose_matrix((1.0, 2.0, 3.0), (x, y, z, w))
        found = np.array(wxyz_of(pose))
        assert np.linalg.norm(found) == pytest.approx(1.0)
        assert abs(found @ (w, x, y, z)) == pytest.approx(np.linalg.norm((w, x, y, z)))
