"""Programs end on a signal while they wait for the master."""

import signal
import subprocess
import sys
import time

import pytest
from slow_master import slow_master

# The first is for a loaded machine; an idle one needs 2 s.
END_SECONDS, ANSWER_SECONDS = 40.0, 1.0
SAVER = "from map_lite.ros.map_saver import main; main()"
DRIVER = "from home_service import Commander; Commander(); print('goes on')"


def interrupt_program(code, topic, number):
    """Return exit code and output of a program that receives a signal while it subscribes to a topic."""
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
def test_a_map_saver_ends_without_a_map(number):
    returned, _ = interrupt_program(SAVER, "/map", number)
    assert returned in (130, 128 + number)


def test_a_script_with_a_commander_runs_to_its_end_without_ros():
    assert interrupt_program(DRIVER, "/tf", signal.SIGINT) == (0, "goes on\n")
