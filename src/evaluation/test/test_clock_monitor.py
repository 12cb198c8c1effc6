import time

import pytest
from gazebo_msgs.srv import GetPhysicsPropertiesResponse

from evaluation.ros import clock_monitor
from evaluation.ros.clock_monitor import ClockMonitor, why_clock_stopped
from planar_ros.calls.services import ServiceError


@pytest.fixture
def paused(monkeypatch):
    monkeypatch.setattr(clock_monitor, "why_clock_stopped", lambda names: "the simulation is paused")


def reason_of(monitor, seconds=2.0):
    """Until there is a reason, or for so long."""
    deadline = time.monotonic() + seconds
    while monitor.reason is None and time.monotonic() < deadline:
        monitor.check()
        time.sleep(0.01)
    return monitor.reason


def test_a_stopped_clock_is_logged_once_with_the_reason(paused):
    logged = []
    monitor = ClockMonitor(logged.append, patience=0.05)
    monitor.on_clock(12.3)
    assert reason_of(monitor) == "simulated time stands still at 12.3 s: the simulation is paused"
    monitor.check()
    monitor.on_clock(12.3)
    assert logged == [monitor.reason]


def test_a_running_clock_has_no_reason(paused):
    logged = []
    monitor = ClockMonitor(logged.append, patience=0.05)
    monitor.check()
    monitor.on_clock(12.3)
    reason_of(monitor)
    monitor.on_clock(12.4)
    assert monitor.reason is None
    assert len(logged) == 1


def test_a_clock_that_was_never_published_is_not_reported(paused):
    monitor = ClockMonitor(pytest.fail, patience=0.0)
    assert reason_of(monitor, 0.1) is None


def answering(monkeypatch, is_paused):
    answer = GetPhysicsPropertiesResponse(pause=is_paused)
    monkeypatch.setattr(clock_monitor, "call_service", lambda *_: answer)


def test_nodes_that_the_simulator_waits_for_are_named(monkeypatch):
    answering(monkeypatch, is_paused=False)
    monitor = ClockMonitor(lambda line: None, patience=0.05)
    monitor.on_clock(12.3)
    monitor.on_waiting("amcl\nmove_base")
    reason = "simulated time stands still at 12.3 s: the simulator waits for amcl, move_base"
    assert reason_of(monitor) == reason


def test_a_pause_is_reported_even_if_nodes_were_waited_for(monkeypatch):
    answering(monkeypatch, is_paused=True)
    assert why_clock_stopped(["amcl"]) == "the simulation is paused"


def test_a_simulator_that_does_not_answer_is_named(monkeypatch):
    def silence(*_):
        raise ServiceError("no answer within 3 s")

    monkeypatch.setattr(clock_monitor, "call_service", silence)
    assert why_clock_stopped([]) == "the simulator does not answer (no answer within 3 s)"
