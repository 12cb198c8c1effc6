"""Missing inputs and stalls are published after a while, and withdrawn at once."""

import pytest

from planar_ros.node import readiness
from planar_ros.node.readiness import ReadinessMonitor, StallReporter


@pytest.fixture
def published(monkeypatch):
    texts = []

    class Publisher:
        def __init__(self, *_arguments, **_named):
            pass

        def publish(self, text):
            texts.append(text)

    monkeypatch.setattr(readiness.rospy, "Publisher", Publisher)
    monkeypatch.setattr(readiness._WaitingForPublisher, "_missing_by_part", {})
    monkeypatch.setattr(readiness._WaitingForPublisher, "_published", None)
    return texts


def update(reporter, monkeypatch, *readings):
    for time, names in readings:
        monkeypatch.setattr(readiness.time, "monotonic", lambda time=time: time)
        reporter.update(names)


def test_a_short_wait_is_not_published(published, monkeypatch):
    update(
        StallReporter(1.0),
        monkeypatch,
        (0.0, ["amcl"]),
        (0.9, ["amcl"]),
        (1.0, []),
        (1.5, ["amcl"]),
        (2.4, ["amcl"]),
    )
    assert published == []


def test_a_long_wait_is_published_once_and_withdrawn(published, monkeypatch):
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
    assert published == ["amcl\nmove_base", "amcl", ""]


def test_a_ready_component_does_not_hide_what_another_one_lacks(published, monkeypatch):
    monkeypatch.setattr(readiness.threading.Thread, "start", lambda _: None)
    is_warm, has_map = [], []
    kernels, inputs = (
        ReadinessMonitor({"kernels": lambda: is_warm}),
        ReadinessMonitor({"a map": lambda: has_map}),
    )
    kernels._check()
    inputs._check()
    is_warm.append(True)
    kernels._check()
    has_map.append(True)
    inputs._check()
    assert published == ["kernels", "kernels\na map", "a map", ""]
