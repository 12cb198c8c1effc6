"""A program that is asked to end while the master lets it wait ends."""

import signal
import subprocess
import sys
import time

import pytest
from slow_master import slow_master

# Of a machine that has other things to do; else two.
END_SECONDS, ANSWER_SECONDS = 40.0, 1.0
SAVER = "from map_lite.ros.map_saver import main; main()"
DRIVER = "from home_service import Commander; Commander(); print('goes on')"


def ending(code, topic, number):
    """The exit code and output of a program which the signal finds while it subscribes to the topic."""
    started = []

    def interrupt():
        started[0].send_signal(number)
        time.sleep(ANSWER_SECONDS)

    with slow_master(topic, interrupt) as environment:
        command = [sys.executable, "-c", code]
        with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as program:
            started.append(program)
            try:
                output, _ = program.communicate(timeout=END_SECONDS)
            finally:
                program.kill()
    return program.returncode, output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_map_saver_has_saved_nothing_then(number):
    returned, _ = ending(SAVER, "/map", number)
    assert returned in (130, 128 + number)


def test_a_script_with_a_commander_goes_on_to_its_end_without_ros():
    assert ending(DRIVER, "/tf", signal.SIGINT) == (0, "goes on\n")
