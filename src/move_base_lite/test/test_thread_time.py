"""A plugin does not fail because the machine is busy with other processes."""

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from move_base_lite import thread_time
from move_base_lite.errors import PluginFailed
from move_base_lite.plugin_guard import MAX_CALL_SECONDS, PluginGuard
from move_base_lite.thread_time import MAX_AGE, Stopwatch

SPINNING = "while True: pass"


@pytest.fixture
def crowded():
    """Run on one processor together with five busy processes."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    others = [subprocess.Popen([sys.executable, "-c", SPINNING]) for _ in range(5)]
    yield
    for other in others:
        other.kill()
        other.wait()
    os.sched_setaffinity(0, before)


def work(seconds):
    """Use so many seconds of processor time."""
    end = time.thread_time() + seconds
    while time.thread_time() < end:
        pass


def test_a_plugin_that_waits_for_a_processor_does_not_fail(crowded):
    guard = PluginGuard("busy/Planner", lambda: work, PluginFailed)
    began = time.perf_counter()
    for seconds in (0.0, 0.5):
        with guard.watch() as plugin:
            plugin(seconds)
    assert time.perf_counter() - began > MAX_CALL_SECONDS, "the thread had to wait"


def test_a_plugin_that_sleeps_fails():
    guard = PluginGuard("idle/Planner", lambda: time.sleep, PluginFailed)
    with guard.watch() as plugin:
        plugin(0.0)
    message = r"idle/Planner took 1\.\d s for an answer"
    with pytest.raises(PluginFailed, match=message), guard.watch() as plugin:
        plugin(MAX_CALL_SECONDS + 0.1)


def test_each_thread_is_measured_separately(crowded):
    waited = []

    def measure():
        began, watch = time.perf_counter(), Stopwatch()
        work(0.1)
        waited.append((time.perf_counter() - began) - watch.seconds())

    threads = [threading.Thread(target=measure) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert min(waited) > 0.05


def test_a_forked_process_is_measured_separately(crowded):
    """Its waiting time starts at zero, however long its parent has waited."""
    work(0.3)
    Stopwatch()
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        began, watch = time.perf_counter(), Stopwatch()
        work(0.1)
        os.write(writer, repr(watch.seconds() / (time.perf_counter() - began)).encode())
        os._exit(0)
    os.waitpid(child, 0)
    assert float(os.read(reader, 99)) < 0.9, "its own waiting time is subtracted"


def test_without_scheduler_statistics_wall_time_is_measured(monkeypatch):
    monkeypatch.setattr(thread_time, "STATISTICS", Path("/nowhere/schedstat"))
    monkeypatch.setattr(thread_time, "_thread", thread_time._Thread())
    watch = Stopwatch()
    time.sleep(2.0 * MAX_AGE)
    assert watch.seconds() >= 2.0 * MAX_AGE
