"""Periodic callbacks in ROS time, with a clock set by the test."""

import threading
import time

import pytest
import rospy

from planar_ros.lockstep.ticker import Ticker
from rospy_transport.node import set_time, unregistered_node

PERIOD = 0.1


@pytest.fixture
def clock():
    """Sets ROS time [s] and wakes waiting threads."""
    with unregistered_node():
        set_time(rospy.Time(0))
        yield lambda seconds: set_time(rospy.Time.from_sec(seconds))


class Node:
    """A node with a ticker; ``in_first_tick`` is called within the first tick."""

    def __init__(self, monkeypatch, in_first_tick=lambda: None, is_synchronized=lambda: False):
        self.ticks, self.time_jumps = [], 0
        self._in_first_tick, self._has_ended = in_first_tick, threading.Event()
        monkeypatch.setattr(rospy, "is_shutdown", self._has_ended.is_set)
        self.ticker = Ticker(lambda: PERIOD, self._tick, self._on_time_jump)
        before = set(threading.enumerate())
        self.ticker.start(is_synchronized, lambda now: None)
        (self._thread,) = set(threading.enumerate()) - before

    def _tick(self, now):
        self.ticks.append(now.to_sec())
        if len(self.ticks) == 1:
            self._in_first_tick()

    def _on_time_jump(self):
        self.time_jumps += 1

    def end(self):
        self._has_ended.set()
        set_time(rospy.Time(1000))
        self._thread.join(10.0)


def wait_until(is_so):
    deadline = time.monotonic() + 10.0
    while not is_so():
        assert time.monotonic() < deadline
        time.sleep(0.001)


def test_a_jump_back_of_time_during_a_tick_is_detected(clock, monkeypatch):
    node = Node(monkeypatch, in_first_tick=lambda: clock(80.0))
    clock(100.0)
    wait_until(lambda: node.time_jumps == 1 and node.ticks == [100.0, 80.0])
    clock(80.0 + 1.5 * PERIOD)
    wait_until(lambda: len(node.ticks) == 3)
    assert node.time_jumps == 1
    node.end()


def test_in_lockstep_a_jump_back_is_handled_by_poll_only(clock, monkeypatch):
    is_synchronized = threading.Event()
    node = Node(monkeypatch, is_synchronized=is_synchronized.is_set)
    clock(100.0)
    wait_until(lambda: node.ticks == [100.0])
    is_synchronized.set()
    clock(80.0)
    node.ticker.poll()
    assert (node.ticks, node.time_jumps) == ([100.0, 80.0], 1)
    time.sleep(0.3)
    assert (node.ticks, node.time_jumps) == ([100.0, 80.0], 1)
    node.end()


def test_a_shorter_period_applies_at_once_and_is_no_time_jump(clock):
    periods, ticks, jumps = [0.5], [], []
    ticker = Ticker(lambda: periods[0], lambda now: ticks.append(now.to_sec()), lambda: jumps.append(True))
    for seconds, period in ((1.0, 0.5), (1.0625, 0.125), (1.25, 0.125)):
        clock(seconds)
        periods[0] = period
        ticker.poll()
    assert (ticks, jumps) == ([1.0, 1.25], [])


def test_after_a_jump_ahead_the_second_poll_ticks(clock, monkeypatch):
    node = Node(monkeypatch, is_synchronized=lambda: True)
    for stamp in (100.0, 100.25, 160.0, 160.25, 160.5):
        clock(stamp)
        node.ticker.poll()
    assert node.ticks == [100.0, 100.25, 160.25, 160.5]
    node.end()


def test_a_node_whose_period_is_longer_than_that_of_others_ticks_at_each_poll(clock, monkeypatch):
    node = Node(monkeypatch, is_synchronized=lambda: True)
    node.ticker = Ticker(lambda: 5.0, node._tick, node._on_time_jump)
    for stamp in (100.0, 105.0, 110.0):
        clock(stamp)
        node.ticker.poll()
    assert node.ticks == [100.0, 105.0, 110.0]
    node.end()
