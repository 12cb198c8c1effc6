"""A guarded command ends with its parent, at any moment."""

import os
import random
import signal
import subprocess
import sys
import time
import uuid
from pathlib import Path

import psutil
import pytest

MARK = "GUARD_TEST"
# Much longer than an end takes, so that it is distinguished from none.
LEFT_SECONDS, START_SECONDS = 30.0, 30.0
PATIENCE_SECONDS, LONG_PATIENCE_SECONDS = 3.0, 20.0
STARTER = """
import subprocess, sys, time
from supervision.guard import guarded, ignore_ctrl_c
guard = subprocess.Popen(guarded(sys.argv[1:]), start_new_session=True, preexec_fn=ignore_ctrl_c)
print("started", flush=True)
sys.exit(guard.wait())
"""
WAITER = """
import sys
from supervision.guard import run_guarded
patience, *command = sys.argv[1:]
sys.exit(run_guarded(command, float(patience)))
"""
# As roslaunch while it starts a node: ignores signals, with children in separate sessions.
STUBBORN = "trap '' INT TERM; while true; do sleep 0.05; done"
DEAF_PARENT = f'trap "" INT TERM; for i in 1 2 3 4 5; do setsid bash -c "{STUBBORN}" & sleep 0.05; done; wait'


@pytest.fixture
def mark():
    mark = str(uuid.uuid4())
    yield mark
    for process in processes_of(mark):
        process.kill()


def start(mark, *command, by=STARTER):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), MARK: mark}
    starter = [sys.executable, "-c", by, *command]
    return subprocess.Popen(starter, env=environment, stdout=subprocess.PIPE, preexec_fn=handle_hang_up)


def start_waiting(mark, patience, *command):
    return start(mark, str(patience), *command, by=WAITER)


def handle_hang_up():
    """Also where the tests themselves run under nohup."""
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def processes_of(mark):
    found = []
    for process in psutil.process_iter():
        try:
            is_one = f"{MARK}={mark}".encode() in Path(f"/proc/{process.pid}/environ").read_bytes()
            if is_one and process.status() != psutil.STATUS_ZOMBIE:
                found.append(process)
        except (OSError, psutil.Error):
            continue
    return found


def seconds_until(is_so, most):
    started = time.monotonic()
    while not is_so():
        assert time.monotonic() - started < most, "without success"
        time.sleep(0.02)
    return time.monotonic() - started


def test_nothing_outlives_a_parent_that_is_killed_at_any_moment(mark):
    moments = random.Random(1)
    for _ in range(8):
        starter = start(mark, "bash", "-c", DEAF_PARENT)
        starter.stdout.readline()
        time.sleep(moments.uniform(0.0, 0.4))
        starter.kill()
        starter.wait()
        seconds_until(lambda: not processes_of(mark), LEFT_SECONDS)


def test_a_guard_that_is_asked_to_end_interrupts_its_command_first(mark, tmp_path):
    log, ready = tmp_path / "log", tmp_path / "ready"
    signalling = f"trap 'echo INT > {log}; exit 3' INT; touch {ready}; while true; do sleep 0.05; done"
    starter = start(mark, "bash", "-c", signalling)
    seconds_until(ready.exists, START_SECONDS)
    guard = psutil.Process(starter.pid).children()[0]
    guard.terminate()
    assert starter.wait(LEFT_SECONDS) == 3
    assert log.read_text() == "INT\n"


def test_ctrl_c_is_for_the_command(mark):
    starter = start(mark, "bash", "-c", "trap 'exit 4' INT; echo ready; while true; do sleep 0.05; done")
    assert [starter.stdout.readline() for _ in range(2)]
    os.killpg(psutil.Process(starter.pid).children()[0].pid, signal.SIGINT)
    assert starter.wait(LEFT_SECONDS) == 4


@pytest.mark.parametrize("how, code", [("exit 5", 5), ("kill -KILL $$", 256 - signal.SIGKILL)])
def test_the_guard_exits_like_its_command(mark, how, code):
    assert start(mark, "bash", "-c", how).wait(START_SECONDS) == code


def test_what_a_command_leaves_behind_is_ended(mark):
    starter = start(mark, "bash", "-c", f'setsid bash -c "{STUBBORN}" & exit 0')
    assert starter.wait(START_SECONDS) == 0
    assert not processes_of(mark)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_run_guarded_waits_for_the_end_of_the_command(mark, number):
    signalling = "trap 'sleep 2.5; exit 3' INT; trap '' HUP; echo ready; while true; do sleep 0.05; done"
    starter = start_waiting(mark, LONG_PATIENCE_SECONDS, "bash", "-c", signalling)
    assert starter.stdout.readline() == b"ready\n"
    starter.send_signal(number)
    assert starter.wait(LEFT_SECONDS) == 3
    assert not processes_of(mark)


def test_a_guarded_command_that_is_terminated_as_it_starts_returns_its_own_code(mark):
    moments = random.Random(2)
    codes = set()
    signalling = "trap 'exit 3' INT; while true; do sleep 0.02; done"
    for _ in range(12):
        starter = start_waiting(mark, PATIENCE_SECONDS, "bash", "-c", signalling)
        seconds_until(lambda: psutil.Process(starter.pid).children(), START_SECONDS)  # noqa: B023
        time.sleep(moments.uniform(0.0, 0.15))
        starter.terminate()
        codes.add(starter.wait(LEFT_SECONDS))
        seconds_until(lambda: not processes_of(mark), LEFT_SECONDS)
    # Its own end, or that of the guard or of the command before either had a handler.
    assert codes <= {3, 128 + signal.SIGTERM, 128 + signal.SIGINT}, codes


def test_nothing_outlives_a_guarded_command_or_its_parent(mark):
    for place in (0, 1, 2):
        starter = start_waiting(mark, PATIENCE_SECONDS, "bash", "-c", f"echo ready; {DEAF_PARENT}")
        assert starter.stdout.readline() == b"ready\n"
        chain = [starter, *psutil.Process(starter.pid).children(recursive=True)]
        chain[place].kill()
        starter.wait(LEFT_SECONDS)
        seconds_until(lambda: not processes_of(mark), LEFT_SECONDS)
