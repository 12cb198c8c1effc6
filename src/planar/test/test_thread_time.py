"""A plugin does not fail because the machine is busy with other processes."""

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from planar.extensions import MAX_CALL_SECONDS, ExtensionPoint, PluginError, thread_time
from planar.extensions.thread_time import MAX_AGE, Stopwatch

SPINNING = "while True: pass"


class Worker:
    def work(self, seconds):
        """Use so many seconds of processor time."""
        end = time.thread_time() + seconds
        while time.thread_time() < end:
            pass

    def sleep(self, seconds):
        time.sleep(seconds)


CONTRACT = ExtensionPoint("worker", Worker, "workers", max_seconds=MAX_CALL_SECONDS)


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


def test_a_plugin_that_waits_for_a_processor_does_not_fail(crowded):
    plugin = CONTRACT.guarded("busy/Worker", Worker)
    began = time.perf_counter()
    for seconds in (0.0, 0.5):
        plugin.work(seconds)
    assert time.perf_counter() - began > MAX_CALL_SECONDS, "the thread had to wait"


def test_a_plugin_that_sleeps_fails():
    plugin = CONTRACT.guarded("idle/Worker", Worker)
    plugin.sleep(0.0)
    with pytest.raises(PluginError, match=r"idle/Worker took 1\.\d s for an answer"):
        plugin.sleep(MAX_CALL_SECONDS + 0.1)


def test_each_thread_is_measured_separately(crowded):
    waited = []

    def measure():
        began, watch = time.perf_counter(), Stopwatch()
        Worker().work(0.1)
        waited.append((time.perf_counter() - began) - watch.seconds())

    threads = [threading.Thread(target=measure) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert min(waited) > 0.05


def test_a_forked_process_is_measured_separately(crowded):
    """Its waiting time starts at zero, however long its parent has waited."""
    Worker().work(0.3)
    Stopwatch()
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        began, watch = time.perf_counter(), Stopwatch()
        Worker().work(0.1)
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
