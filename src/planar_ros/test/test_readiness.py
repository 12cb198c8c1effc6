"""Who is waited for while a node works is told after a while, and taken back as soon as it goes on."""

import pytest

from planar_ros.node import readiness
from planar_ros.node.readiness import ReadinessMonitor, StallReporter


@pytest.fixture
def told(monkeypatch):
    said = []

    class Publisher:
        def __init__(self, *_arguments, **_named):
            pass

        def publish(self, text):
            said.append(text)

    monkeypatch.setattr(readiness.rospy, "Publisher", Publisher)
    monkeypatch.setattr(readiness._WaitingForPublisher, "_lacking", {})
    monkeypatch.setattr(readiness._WaitingForPublisher, "_told", None)
    return said


def update(reporter, monkeypatch, *moments):
    for moment, names in moments:
        monkeypatch.setattr(readiness.time, "monotonic", lambda moment=moment: moment)
        reporter.update(names)


def test_a_short_wait_is_nothing_to_tell(told, monkeypatch):
    update(
        StallReporter(1.0),
        monkeypatch,
        (0.0, ["amcl"]),
        (0.9, ["amcl"]),
        (1.0, []),
        (1.5, ["amcl"]),
        (2.4, ["amcl"]),
    )
    assert told == []


def test_a_long_wait_is_told_once_and_taken_back(told, monkeypatch):
    both = ["amcl", "move_base"]
    update(
        StallReporter(1.0),
        monkeypatch,
        (0.0, both),
        (1.1, both),
        (1.2, both),
        (1.3, ["amcl"]),
        (1.4, []),
        (1.5, []),
    )
    assert told == ["amcl\nmove_base", "amcl", ""]


def test_who_has_all_that_it_waits_for_does_not_hide_what_another_one_lacks(told, monkeypatch):
    monkeypatch.setattr(readiness.threading.Thread, "start", lambda _: None)
    is_warm, has_map = [], []
    kernels, inputs = (
        ReadinessMonitor({"kernels": lambda: is_warm}),
        ReadinessMonitor({"a map": lambda: has_map}),
    )
    kernels._look()
    inputs._look()
    is_warm.append(True)
    kernels._look()
    has_map.append(True)
    inputs._look()
    assert told == ["kernels", "kernels\na map", "a map", ""]
