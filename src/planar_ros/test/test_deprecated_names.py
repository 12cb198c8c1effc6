"""Documented names of older versions still work, with a warning."""

import pytest

from planar_ros.lockstep import LockstepClient
from planar_ros.lockstep import client as client_module


def test_the_old_name_of_the_lockstep_client_is_importable():
    with pytest.warns(DeprecationWarning, match="use planar_ros.lockstep.LockstepClient"):
        from planar_ros.step import Step
    assert Step is LockstepClient


def test_the_old_keyword_of_periodic_work_is_accepted(monkeypatch):
    given = []

    class FakeTicker:
        poll = None

        def __init__(self, *arguments):
            given.extend(arguments)

        def start(self, *_arguments):
            pass

    monkeypatch.setattr(client_module, "Ticker", FakeTicker)
    monkeypatch.setattr(client_module.rospy, "get_name", lambda: "/amcl")
    monkeypatch.setattr(client_module.rospy, "get_param", lambda _, default=None: default)
    client, tick, reset = LockstepClient(), lambda now: None, lambda: None
    with pytest.warns(DeprecationWarning, match="use on_time_jump"):
        client.every(lambda: 0.1, tick=tick, afresh=reset)
    assert given[1:] == [tick, reset]


def test_observers_are_also_read_from_the_old_parameter(monkeypatch):
    parameters = {"/simulation/audience": ["/referee"]}
    monkeypatch.setattr(client_module.rospy, "get_param", parameters.get)
    assert client_module.observers() == {"/referee"}
