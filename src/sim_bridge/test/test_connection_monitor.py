"""Simulated time does not pass before synchronised nodes and observers are there and connected."""

import time

import pytest

from sim_bridge.ros.timing import connection_monitor
from sim_bridge.ros.timing.connection_monitor import (
    EXPECTED_OBSERVERS_PARAMETER,
    OLD_PARAMETER,
    ConnectionMonitor,
)

DEADLINE, LATE_SECONDS = 5.0, 0.3
MISSING = "the observer /referee"


class AllConnected:
    """Every node is there and connected."""

    def known_nodes(self):
        return {"/amcl"}, {"/amcl"}

    def missing(self, members, observers, static_publishers):
        return []


@pytest.fixture
def parameters(monkeypatch):
    """The parameters of the master, which a test may change."""
    values = {EXPECTED_OBSERVERS_PARAMETER: "referee"}
    shutdown = []
    monkeypatch.setattr(connection_monitor, "ConnectionCheck", AllConnected)
    monkeypatch.setattr(connection_monitor.rospy, "get_param", values.get)
    monkeypatch.setattr(connection_monitor.rospy, "is_shutdown", lambda: bool(shutdown))
    monkeypatch.setattr(connection_monitor.rospy, "logwarn", lambda *_: None)
    yield values
    shutdown.append(True)


def joined():
    """A monitor whose only node has joined."""
    monitor = ConnectionMonitor("/sim_bridge", ["/amcl"], [])
    monitor.add_node("/amcl")
    return monitor


def is_complete_within(monitor, seconds):
    end = time.monotonic() + seconds
    while not monitor.is_complete and time.monotonic() < end:
        time.sleep(0.01)
    return monitor.is_complete


def test_expected_observers_are_waited_for(parameters):
    monitor = joined()
    assert not is_complete_within(monitor, LATE_SECONDS)
    assert MISSING in monitor.missing()
    parameters["/simulation/observers"] = ["/referee"]
    assert is_complete_within(monitor, DEADLINE)
    assert monitor.observers == {"/referee"}
    assert monitor.given_up() == []


def test_an_observer_that_does_not_start_is_given_up(parameters, monkeypatch):
    monkeypatch.setattr(connection_monitor, "START_SECONDS", LATE_SECONDS)
    monitor = joined()
    assert is_complete_within(monitor, DEADLINE)
    assert monitor.given_up() == [MISSING]


def test_without_expected_observers_none_is_waited_for(parameters):
    parameters[EXPECTED_OBSERVERS_PARAMETER] = ""
    assert is_complete_within(joined(), DEADLINE)


def test_the_old_name_of_the_parameter_still_works(parameters):
    parameters[OLD_PARAMETER] = parameters.pop(EXPECTED_OBSERVERS_PARAMETER)
    monitor = joined()
    assert not is_complete_within(monitor, LATE_SECONDS)
    assert MISSING in monitor.missing()
    parameters["/simulation/observers"] = ["/referee"]
    assert is_complete_within(monitor, DEADLINE)
