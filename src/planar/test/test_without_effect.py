"""Settings that are accepted and have no effect are named once, counted, and refused by strict programs."""

import pytest

from planar import SettingsError
from planar.config.without_effect import SettingsWithoutEffect, refuse, summary


def test_each_setting_is_named_once_with_its_reason():
    found = SettingsWithoutEffect()
    found.add("/move_base/NavfnROS/planner_window_x", "navfn does not use it either")
    found.add("/move_base/NavfnROS/planner_window_x")
    found.add("home.world:12: <audio>")
    assert list(found) == [
        "/move_base/NavfnROS/planner_window_x has no effect: navfn does not use it either",
        "home.world:12: <audio> has no effect",
    ]
    assert summary(len(found), "~strict") == (
        "2 settings without effect, see the lines above; ~strict makes this an error"
    )


def test_a_strict_program_refuses_them_all_in_one_error():
    refuse([])
    with pytest.raises(SettingsError, match="a has no effect\nb has no effect"):
        refuse(["a has no effect", "b has no effect"])
