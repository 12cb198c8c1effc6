import time

import pytest

from evaluation.consumers.clock_monitor import ClockMonitor
from evaluation.event_stream import EventStream
from evaluation.events import ClockAdvanced, NodesAwaited


def monitored(log, explain=lambda names: "the simulation is paused", patience=0.05):
    monitor, events = ClockMonitor(log, explain, patience), EventStream()
    monitor.attach(events)
    return monitor, events


def reason_of(monitor, seconds=2.0):
    """Until there is a reason, or for so long."""
    deadline = time.monotonic() + seconds
    while monitor.reason is None and time.monotonic() < deadline:
        monitor.check()
        time.sleep(0.01)
    return monitor.reason


def test_a_stopped_clock_is_logged_once_with_the_reason():
    logged = []
    monitor, events = monitored(logged.append)
    events.publish(ClockAdvanced(12.3))
    assert reason_of(monitor) == "simulated time stands still at 12.3 s: the simulation is paused"
    monitor.check()
    events.publish(ClockAdvanced(12.3))
    assert logged == [monitor.reason]


def test_a_running_clock_has_no_reason():
    logged = []
    monitor, events = monitored(logged.append)
    monitor.check()
    events.publish(ClockAdvanced(12.3))
    reason_of(monitor)
    events.publish(ClockAdvanced(12.4))
    assert monitor.reason is None
    assert len(logged) == 1


def test_a_clock_that_was_never_published_is_not_reported():
    monitor, _ = monitored(pytest.fail, patience=0.0)
    assert reason_of(monitor, 0.1) is None


def test_nodes_that_the_simulator_waits_for_are_passed_on():
    monitor, events = monitored(lambda line: None, explain=", ".join)
    events.publish(ClockAdvanced(12.3))
    events.publish(NodesAwaited(12.3, ("amcl", "move_base")))
    assert reason_of(monitor) == "simulated time stands still at 12.3 s: amcl, move_base"
