"""The warning when no scans arrive."""

import pytest
import rospy

from amcl_lite.ros.scan_watchdog import ScanWatchdog
from rospy_transport.node import set_time, unregistered_node


@pytest.fixture
def watchdog(monkeypatch):
    """A watchdog and the durations [s] of which it has warned."""
    warnings = []
    monkeypatch.setattr(rospy, "logwarn", lambda text, silence, topic: warnings.append(round(silence, 3)))
    with unregistered_node():
        yield ScanWatchdog("/scan"), warnings


def scan_at(watchdog, seconds):
    set_time(rospy.Time(seconds))
    watchdog.on_scan()


def test_it_warns_while_no_scan_arrives(watchdog):
    watched, warnings = watchdog
    scan_at(watched, 10)
    for seconds in (11, 20, 26, 27, 42):
        watched.check(rospy.Time(seconds))
    assert warnings == [16.0, 32.0]


def test_a_jump_of_simulated_time_between_two_scans_is_no_silence(watchdog):
    watched, warnings = watchdog
    for seconds in (10, 70, 130):
        scan_at(watched, seconds)
        watched.check(rospy.Time(seconds + 60))
    assert warnings == []
