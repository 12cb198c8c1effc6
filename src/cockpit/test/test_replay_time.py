"""The tree of frames when ROS time jumps back."""

import numpy as np

from cockpit.frames import FrameTree, Transform


def test_a_jump_back_of_time_drops_dynamic_transforms_and_keeps_static_ones():
    frames = FrameTree()
    frames.put("odom", Transform("map", np.eye(4), 5.0, is_static=False))
    frames.put("laser", Transform("base_link", np.eye(4), 0.0, is_static=True))
    frames.reset()
    assert frames.pose("odom", "map") is None
    assert frames.pose("laser", "base_link") is not None
