import time

import pytest
from gazebo_msgs.srv import GetPhysicsPropertiesResponse

from home_service.ros import standstill
from home_service.ros.standstill import Standstill, why_time_stands
from planar_ros.calls.services import ServiceError


@pytest.fixture
def paused(monkeypatch):
    monkeypatch.setattr(standstill, "why_time_stands", lambda names: "the simulation is paused")


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


def answering(monkeypatch, is_paused):
    answer = GetPhysicsPropertiesResponse(pause=is_paused)
    monkeypatch.setattr(standstill, "call_service", lambda *_: answer)


def test_those_that_the_simulator_waits_for_are_named(monkeypatch):
    answering(monkeypatch, is_paused=False)
    watch = Standstill(lambda line: None, patience=0.05)
    watch.hear(12.3)
    watch.hear_waiting("amcl\nmove_base")
    told = "simulated time stands still at 12.3 s: the simulator waits for amcl, move_base"
    assert looked_at(watch) == told


def test_a_pause_is_a_pause_whoever_was_waited_for(monkeypatch):
    answering(monkeypatch, is_paused=True)
    assert why_time_stands(["amcl"]) == "the simulation is paused"


def test_a_simulator_that_does_not_answer_is_named(monkeypatch):
    def silence(*_):
        raise ServiceError("no answer within 3 s")

    monkeypatch.setattr(standstill, "call_service", silence)
    assert why_time_stands([]) == "the simulator does not answer (no answer within 3 s)"
