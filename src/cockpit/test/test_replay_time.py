"""A view when time begins anew."""

import numpy as np

from cockpit.frames import FrameTree, Transform


def test_what_moves_is_nowhere_when_time_begins_anew_and_what_is_fixed_stays():
    frames = FrameTree()
    frames.put("odom", Transform("map", np.eye(4), 5.0, is_static=False))
    frames.put("laser", Transform("base_link", np.eye(4), 0.0, is_static=True))
    frames.reset()
    assert frames.pose("odom", "map") is None
    assert frames.pose("laser", "base_link") is not None
