"""A node that is shutting down does not ask to be synchronized."""

import threading
import time

import pytest
import rospy

from planar_ros.lockstep import LockstepClient, client


@pytest.fixture
def step(monkeypatch):
    """The lock-step client of a node that is ready; ``answers``: what it has sent."""
    monkeypatch.setattr(rospy, "get_name", lambda: "/amcl")
    monkeypatch.setattr(rospy, "get_param", lambda _, default=None: default)
    step = LockstepClient()
    step.answers = []
    monkeypatch.setattr(step, "_answer", step.answers.append)
    return step


def ask_for_a_while(step, monkeypatch):
    has_ended = threading.Event()
    monkeypatch.setattr(rospy, "is_shutdown", has_ended.is_set)
    asking = threading.Thread(target=step._run, args=(lambda: True,))
    asking.start()
    time.sleep(0.1)
    has_ended.set()
    monkeypatch.setattr(client, "is_shutting_down", lambda: True)
    asking.join(10.0)


def test_a_ready_node_asks_to_be_synchronized(step, monkeypatch):
    ask_for_a_while(step, monkeypatch)
    assert step.answers


def test_a_node_that_is_shutting_down_does_not_ask(step, monkeypatch):
    monkeypatch.setattr(client, "is_shutting_down", lambda: True)
    ask_for_a_while(step, monkeypatch)
    assert not step.answers
