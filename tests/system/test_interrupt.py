#!/usr/bin/env python3
"""However a run is ended from outside, it leaves no process behind and is no success."""

import os
import signal
import subprocess
import tempfile
import time
import unittest
import uuid
from pathlib import Path

import rostest
from processes import processes_with
from waiting import wait_until

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/home_service.sh"
MOMENTS = (0.1, 0.6, 1.5, 3.0, 6.0)
START_SECONDS, EXIT_SECONDS = 60.0, 20.0


class InterruptTest(unittest.TestCase):
    def test_an_interrupted_run_leaves_nothing_behind(self):
        for moment in MOMENTS:
            mark = f"HOME_SERVICE_TEST={uuid.uuid4()}"
            code = self._interrupted_run(moment, mark)
            left = processes_with(mark)
            print(f"interrupted after {moment} s: exit code {code}, {len(left)} processes left")
            self.assertNotEqual(code, 0)
            self.assertEqual(left, [], f"interrupted after {moment} s")

    def test_what_a_person_is_meant_to_end_ends_well(self):
        mark = f"HOME_SERVICE_TEST={uuid.uuid4()}"
        name, value = mark.split("=")
        with tempfile.TemporaryDirectory() as folder:
            run = subprocess.Popen(
                [str(SCRIPT.with_name("launch.sh")), "--output", folder],
                env={**os.environ, name: value},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
            said = []
            for line in run.stdout:
                said.append(line)
                if "Ctrl-C closes it" in line:
                    run.send_signal(signal.SIGINT)
            code = run.wait(EXIT_SECONDS)
        self.assertEqual(code, 0, "".join(said))
        self.assertIn("SUCCESS: ended by Ctrl-C", "".join(said))
        self.assertNotIn("error", "".join(said))
        self.assertEqual(processes_with(mark), [])

    def test_a_terminal_that_closes_ends_the_run(self):
        mark = f"HOME_SERVICE_TEST={uuid.uuid4()}"
        self.assertEqual(self._interrupted_run(None, mark, signal.SIGHUP), 130)
        self.assertEqual(processes_with(mark), [])

    def test_a_killed_run_takes_its_nodes_along(self):
        mark = f"HOME_SERVICE_TEST={uuid.uuid4()}"
        self._interrupted_run(8.0, mark, signal.SIGKILL)
        wait_until("the nodes to end", lambda: not processes_with(mark), EXIT_SECONDS)

    def _interrupted_run(self, moment, mark, number=signal.SIGINT):
        """The exit code; ``moment``: wall seconds after its start, None for when the robot is there."""
        name, value = mark.split("=")
        with tempfile.TemporaryDirectory() as folder:
            run = subprocess.Popen(
                [str(SCRIPT), "--speed", "1", "--output", folder],
                env={**os.environ, name: value},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            if moment is None:
                wait_until("the robot", lambda: _is_there("move_base", mark), START_SECONDS)
            else:
                time.sleep(moment)
            run.send_signal(number)
            return run.wait(EXIT_SECONDS)


def _is_there(node, mark):
    return any(f"__name:={node}" in line for line in processes_with(mark))


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "interrupt", InterruptTest)
