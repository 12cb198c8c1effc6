import time

import pytest

from home_service.ros import standstill
from home_service.ros.standstill import Standstill


@pytest.fixture
def paused(monkeypatch):
    monkeypatch.setattr(standstill, "why_time_stands", lambda: "the simulation is paused")


def looked_at(watch, seconds=2.0):
    """Until there is a reason, or for so long."""
    deadline = time.monotonic() + seconds
    while watch.reason is None and time.monotonic() < deadline:
        watch.look()
        time.sleep(0.01)
    return watch.reason


def test_time_that_stands_still_is_told_once_with_the_reason(paused):
    said = []
    watch = Standstill(said.append, patience=0.05)
    watch.hear(12.3)
    assert looked_at(watch) == "simulated time stands still at 12.3 s: the simulation is paused"
    watch.look()
    watch.hear(12.3)
    assert said == [watch.reason]


def test_time_that_goes_on_is_nothing_to_tell(paused):
    said = []
    watch = Standstill(said.append, patience=0.05)
    watch.look()
    watch.hear(12.3)
    looked_at(watch)
    watch.hear(12.4)
    assert watch.reason is None
    assert len(said) == 1


def test_before_there_is_time_nothing_stands_still(paused):
    watch = Standstill(pytest.fail, patience=0.0)
    assert looked_at(watch, 0.1) is None
