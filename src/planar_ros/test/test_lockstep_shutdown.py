"""A node that is ending is not in step any more, and does not ask to be."""

import threading
import time

import pytest
import rospy

from planar_ros.lockstep import LockstepClient


@pytest.fixture
def step(monkeypatch):
    """That of a node which is ready; ``said``: its answers."""
    monkeypatch.setattr(rospy, "get_name", lambda: "/amcl")
    monkeypatch.setattr(rospy, "get_param", lambda _, default=None: default)
    step = LockstepClient()
    step.said = []
    monkeypatch.setattr(step, "_answer", step.said.append)
    return step


def ask_for_a_while(step, monkeypatch):
    has_ended = threading.Event()
    monkeypatch.setattr(rospy, "is_shutdown", has_ended.is_set)
    asking = threading.Thread(target=step._ask, args=(lambda: True,))
    asking.start()
    time.sleep(0.1)
    has_ended.set()
    monkeypatch.setattr(rospy.core, "_in_shutdown", True)
    asking.join(10.0)


def test_a_node_asks_to_be_in_step(step, monkeypatch):
    ask_for_a_while(step, monkeypatch)
    assert step.said


def test_a_node_that_is_ending_does_not(step, monkeypatch):
    monkeypatch.setattr(rospy.core, "_in_shutdown", True)
    ask_for_a_while(step, monkeypatch)
    assert not step.said
