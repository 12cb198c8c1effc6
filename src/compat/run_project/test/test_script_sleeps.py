"""The sleep of scripts lasts for simulated time."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from run_project.script_sleeps import ROUNDING, STANDSTILL_SECONDS, STARTING_SECONDS, ScriptSleeps, ScriptTime
from run_project.stand_ins import STAND_INS
from run_project.stand_ins.sleep import SOCKET_VARIABLE, seconds_of

LIMIT_SECONDS = 60.0


class Hold:
    """A hold of the simulation that notes the ends of sleeps."""

    def __init__(self, on_end=lambda end: None):
        self.on_end = on_end

    def begin_sleep(self, end):
        pass

    def end_sleep(self, end, now):
        self.on_end(end)


def test_wall_time_passes_until_a_simulation_runs_and_simulated_time_from_then_on():
    elapsed = ScriptTime(100.0, 0.0)
    assert elapsed.update(102.0, 0.0) == pytest.approx(2.0)
    assert elapsed.update(102.1, 0.5) == pytest.approx(0.5)
    assert elapsed.update(102.2, 0.5) == pytest.approx(0.5)
    assert elapsed.update(102.3, 2.5) == pytest.approx(2.5)


def test_no_time_passes_for_a_script_while_programs_start_but_not_for_ever():
    elapsed = ScriptTime(100.0, 0.0)
    assert elapsed.update(104.0, 0.0, is_starting=True) == 0.0
    assert elapsed.update(105.0, 0.0) == pytest.approx(1.0)
    assert elapsed.update(105.0 + STARTING_SECONDS, 0.0, is_starting=True) == pytest.approx(1.0)
    assert elapsed.update(107.0 + STARTING_SECONDS, 0.0, is_starting=True) == pytest.approx(3.0)


def test_simulated_time_passes_while_programs_start():
    elapsed = ScriptTime(100.0, 5.0)
    assert elapsed.update(101.0, 7.0, is_starting=True) == pytest.approx(2.0)
    assert elapsed.update(109.0, 7.0, is_starting=True) == pytest.approx(2.0), "it is held"


def test_a_simulation_that_stands_still_does_not_stop_a_script():
    elapsed = ScriptTime(0.0, 7.0)
    elapsed.update(0.1, 8.0)
    stopped = [elapsed.update(0.1 + 0.1 * step, 8.0) for step in range(1, 31)]
    assert stopped[int(STANDSTILL_SECONDS / 0.1) - 1] == pytest.approx(1.0)
    assert stopped[-1] == pytest.approx(1.0 + 3.0 - STANDSTILL_SECONDS, abs=0.11)


def test_a_clock_that_is_set_back_takes_nothing_away():
    elapsed = ScriptTime(0.0, 50.0)
    elapsed.update(0.1, 52.0)
    assert elapsed.update(0.2, 0.0) == pytest.approx(2.0)
    assert elapsed.update(0.3, 1.0) == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("words", "seconds"),
    [
        (["5"], 5.0),
        ([".5"], 0.5),
        (["1m", "2.5"], 62.5),
        (["2h"], 7200.0),
        (["infinity"], None),
        (["--help"], None),
        (["five"], None),
        (["-1"], None),
        ([], None),
    ],
)
def test_durations_are_those_of_the_real_program(words, seconds):
    assert seconds_of(words) == seconds


def environment(**variables):
    path = {
        "PATH": f"{STAND_INS / 'bin'}:{os.environ['PATH']}",
        "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
    }
    return {**os.environ, **path, **variables}


def test_a_script_continues_when_the_simulated_time_has_passed():
    clock, ends = [3.0], []
    with ScriptSleeps(lambda: clock[0], Hold(lambda end: ends.append((end, clock[0])))) as sleeps:
        script = subprocess.Popen(
            ["sh", "-c", "sleep 1000 && sleep 500"], env=environment(**{SOCKET_VARIABLE: sleeps.address})
        )
        deadline = time.monotonic() + LIMIT_SECONDS
        while script.poll() is None and time.monotonic() < deadline:
            clock[0] += 1.0
            time.sleep(0.001)
        assert script.poll() == 0
    (first, at_first), (second, at_second) = ends
    assert first >= 1003.0
    assert at_first >= first - ROUNDING
    assert second >= first + 500.0
    assert at_second >= second - ROUNDING


@pytest.mark.parametrize(("is_starting", "is_time_due"), [(False, False), (True, False), (False, True)])
def test_while_no_time_can_begin_a_sleep_ends_when_all_programs_have_come_up(is_starting, is_time_due):
    """Where it can, the next window must not open before that time begins, on some machines only."""
    is_awaited = is_starting or is_time_due
    clock = [0.0]
    with ScriptSleeps(lambda: clock[0], Hold()) as sleeps:
        sleeper = threading.Thread(target=sleeps.sleep, args=(1000.0,))
        sleeper.start()
        deadline = time.monotonic() + (1.0 if is_awaited else LIMIT_SECONDS)
        while sleeper.is_alive() and time.monotonic() < deadline:
            sleeps.update(is_starting, is_time_due)
            time.sleep(0.01)
        assert sleeper.is_alive() == is_awaited
        clock[0] = 1001.0
        sleeper.join(LIMIT_SECONDS)
        assert not sleeper.is_alive()


def test_the_end_of_the_run_ends_a_sleep():
    with ScriptSleeps(lambda: 0.0, Hold()) as sleeps:
        sleeper = threading.Thread(target=sleeps.sleep, args=(1e6,))
        sleeper.start()
    sleeper.join(LIMIT_SECONDS)
    assert not sleeper.is_alive()


@pytest.mark.parametrize("variables", [{}, {SOCKET_VARIABLE: "absent_socket"}])
def test_without_a_run_it_is_the_real_program(variables):
    done = subprocess.run(
        ["sleep", "--version"], env=environment(**variables), capture_output=True, check=True
    )
    assert b"coreutils" in done.stdout
    begun = time.monotonic()
    subprocess.run(["sleep", "0.2"], env=environment(**variables), check=True)
    assert time.monotonic() - begun >= 0.2


def test_a_signal_ends_it_as_it_ends_the_real_program():
    with ScriptSleeps(lambda: 0.0, Hold()) as sleeps:
        sleep = subprocess.Popen(["sleep", "1000"], env=environment(**{SOCKET_VARIABLE: sleeps.address}))
        sleep.terminate()
        assert sleep.wait(LIMIT_SECONDS) == -signal.SIGTERM
