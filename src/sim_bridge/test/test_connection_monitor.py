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

    def local_process(self, name):
        return None

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
    time.sleep(5.0 * connection_monitor.POLL_SECONDS)  # the threads still use what is patched


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
    assert monitor.shortcomings() == []


def test_an_observer_that_does_not_start_is_given_up(parameters, monkeypatch):
    monkeypatch.setattr(connection_monitor, "START_SECONDS", LATE_SECONDS)
    monitor = joined()
    assert is_complete_within(monitor, DEADLINE)
    assert monitor.shortcomings() == [f"time went on without {MISSING}"]


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


class OtherProgram(AllConnected):
    """amcl has started and does not support lock-step; it runs in a process."""

    pid = None

    def known_nodes(self):
        return {"/amcl"}, set()

    def local_process(self, name):
        return self.pid


def test_a_native_program_is_not_waited_for(parameters, monkeypatch):
    monkeypatch.setattr(connection_monitor, "ConnectionCheck", OtherProgram)
    monkeypatch.setattr(connection_monitor, "is_native", lambda pid: pid == 7)
    monkeypatch.setattr(OtherProgram, "pid", 7)
    parameters.clear()
    monitor = ConnectionMonitor("/sim_bridge", ["/amcl"], [])
    assert is_complete_within(monitor, DEADLINE / 2)
    assert (monitor.unable, monitor.shortcomings()) == ({"/amcl"}, ["/amcl does not support lock-step"])
    assert monitor.shortcomings() == [], "each is reported once"


def test_a_node_that_does_not_ask_for_lock_step_is_waited_for_for_some_time(parameters, monkeypatch):
    monkeypatch.setattr(connection_monitor, "ConnectionCheck", OtherProgram)
    monkeypatch.setattr(connection_monitor, "JOIN_SECONDS", LATE_SECONDS)
    parameters.clear()
    monitor = ConnectionMonitor("/sim_bridge", ["/amcl"], [])
    assert not is_complete_within(monitor, LATE_SECONDS / 2)
    assert is_complete_within(monitor, DEADLINE)
    monitor.add_node("/amcl")
    assert monitor.unable == frozenset()
