"""The speed reaches a simulator that has read its parameters but has no services yet."""

import threading

import pytest
import rospy

from run_project.ros import simulator_speed
from run_project.ros.simulator_speed import SimulatorSpeed


@pytest.fixture
def simulator(monkeypatch):
    """Speeds that a simulator took which answers the third call; an event that it took no limit."""
    calls, taken, is_free = [], [], threading.Event()

    def set_physics_speed(speed):
        calls.append(speed)
        if len(calls) < 3:
            return False
        taken.append(speed)
        if speed == 0.0:
            is_free.set()
        return True

    monkeypatch.setattr(rospy, "set_param", lambda *_: None)
    monkeypatch.setattr(simulator_speed, "RETRY_SECONDS", 0.01)
    monkeypatch.setattr(simulator_speed, "set_physics_speed", set_physics_speed)
    ended = threading.Event()
    monkeypatch.setattr(rospy, "is_shutdown", ended.is_set)
    yield taken, is_free
    ended.set()


def test_a_speed_that_is_set_while_the_simulator_starts_is_repeated(simulator):
    taken, is_free = simulator
    SimulatorSpeed().set(0.0)
    assert is_free.wait(5.0)
    assert taken == [0.0]


def test_the_latest_of_several_speeds_is_the_last_one_taken(simulator):
    taken, is_free = simulator
    speed = SimulatorSpeed()
    for multiple in (1.0, 2.0, 0.0):
        speed.set(multiple)
    assert is_free.wait(5.0)
    assert taken[-1] == 0.0
