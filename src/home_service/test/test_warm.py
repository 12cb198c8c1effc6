"""Kernels are compiled during the set-up."""

from home_service import warm
from move_base_lite.control import LOCAL_PLANNERS


def test_every_local_planner_is_compiled_ahead_of_time(monkeypatch):
    warmed = []
    monkeypatch.setattr(warm, "warm_up_navigator", lambda settings: warmed.append(type(settings.controller)))
    warm.warm_up_local_planners()
    assert set(warmed) == {member.settings for member in LOCAL_PLANNERS.members}
