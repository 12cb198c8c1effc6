"""The loop is not closed before those who are to look on do."""

import time

import pytest

from sim_bridge.ros.timing import loop_watch
from sim_bridge.ros.timing.loop_watch import EXPECTED_AUDIENCE_PARAMETER, LoopWatch

DEADLINE, LATE_SECONDS = 5.0, 0.3
GAP = "the node /referee, which is to look on"


class FakeConnectionCheck:
    """All are there and connected."""

    def known(self):
        return {"/amcl"}, {"/amcl"}

    def gaps(self, members, audience, static_publishers):
        return []


@pytest.fixture
def parameters(monkeypatch):
    """Those of the master, which a test may change."""
    found = {EXPECTED_AUDIENCE_PARAMETER: "referee"}
    over = []
    monkeypatch.setattr(loop_watch, "ConnectionCheck", FakeConnectionCheck)
    monkeypatch.setattr(loop_watch.rospy, "get_param", found.get)
    monkeypatch.setattr(loop_watch.rospy, "is_shutdown", lambda: bool(over))
    monkeypatch.setattr(loop_watch.rospy, "logwarn", lambda *_: None)
    yield found
    over.append(True)


def joined():
    """A loop whose only node has joined."""
    loop = LoopWatch("/sim_bridge", ["/amcl"], [])
    loop.join("/amcl")
    return loop


def is_closed_within(loop, seconds):
    end = time.monotonic() + seconds
    while not loop.is_closed and time.monotonic() < end:
        time.sleep(0.01)
    return loop.is_closed


def test_who_is_to_look_on_is_waited_for(parameters):
    loop = joined()
    assert not is_closed_within(loop, LATE_SECONDS)
    assert GAP in loop.gaps()
    parameters["/simulation/audience"] = ["/referee"]
    assert is_closed_within(loop, DEADLINE)
    assert loop.audience == {"/referee"}
    assert loop.given_up() == []


def test_but_not_for_ever(parameters, monkeypatch):
    monkeypatch.setattr(loop_watch, "COMING_SECONDS", LATE_SECONDS)
    loop = joined()
    assert is_closed_within(loop, DEADLINE)
    assert loop.given_up() == [GAP]


def test_where_nobody_is_to_look_on_nobody_is_waited_for(parameters):
    parameters[EXPECTED_AUDIENCE_PARAMETER] = ""
    assert is_closed_within(joined(), DEADLINE)
