#!/usr/bin/env python3
"""However a run is ended from outside, it leaves no process behind and is no success."""

import os
import random
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import uuid
from pathlib import Path

import rostest
from processes import marked_environment, processes_with
from waiting import wait_until

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/home_service.sh"
MOMENTS = (0.1, 0.6, 1.5, 3.0, 6.0)
# Time-outs of an end are much longer than it takes, so that it is distinguished from none.
START_SECONDS, EXIT_SECONDS, LEFT_SECONDS = 60.0, 30.0, 30.0
# Killed by SIGKILL so often, so many seconds after roslaunch has begun, which starts the nodes in these.
STARTS, STARTING_SECONDS = 6, (0.0, 2.5)
ROSLAUNCH, MOVE_BASE = "/roslaunch --port", "__name:=move_base"
# Interrupted so many seconds after the process has been started which looks after roslaunch.
GUARD, GUARDING_SECONDS = "-m supervision.guard", (0.0, 0.03)


class InterruptTest(unittest.TestCase):
    def test_an_interrupted_run_leaves_nothing_behind(self):
        for moment in MOMENTS:
            mark = f"HOME_SERVICE_TEST={uuid.uuid4()}"
            code = self._interrupted_run(moment, mark)
            left = processes_with(mark)
            print(f"interrupted after {moment} s: exit code {code}, {len(left)} processes left")
            self.assertNotEqual(code, 0)
            self.assertEqual(left, [], f"interrupted after {moment} s")

    def test_a_run_that_is_interrupted_as_it_starts_its_nodes_leaves_nothing(self):
        moments = random.Random(21)
        for _ in range(STARTS):
            mark, moment = f"HOME_SERVICE_TEST={uuid.uuid4()}", moments.uniform(*GUARDING_SECONDS)
            self.assertEqual(self._interrupted_run(moment, mark, signal.SIGINT, GUARD), 130)
            self.assertEqual(processes_with(mark), [], f"interrupted {moment:.3f} s after the guard of nodes")

    def test_an_interactive_run_succeeds_when_it_is_interrupted(self):
        mark, environment = marked_environment()
        with tempfile.TemporaryDirectory() as folder:
            run = subprocess.Popen(
                [str(SCRIPT.with_name("launch.sh")), "--output", folder],
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
            lines = []
            for line in run.stdout:
                lines.append(line)
                if "Ctrl-C closes it" in line:
                    run.send_signal(signal.SIGINT)
            code = run.wait(EXIT_SECONDS)
        self.assertEqual(code, 0, "".join(lines))
        self.assertIn("SUCCESS: ended by Ctrl-C", "".join(lines))
        self.assertNotIn("error", "".join(lines))
        self.assertEqual(processes_with(mark), [])

    def test_a_terminal_that_closes_ends_the_run(self):
        mark = f"HOME_SERVICE_TEST={uuid.uuid4()}"
        self.assertEqual(self._interrupted_run(0.0, mark, signal.SIGHUP, MOVE_BASE), 130)
        self.assertEqual(processes_with(mark), [])

    def test_the_nodes_of_a_killed_run_end(self):
        mark = f"HOME_SERVICE_TEST={uuid.uuid4()}"
        self._interrupted_run(8.0, mark, signal.SIGKILL)
        wait_until("the nodes to end", lambda: not processes_with(mark), LEFT_SECONDS)

    def test_a_run_that_is_killed_while_it_starts_leaves_nothing(self):
        moments = random.Random(16)
        for _ in range(STARTS):
            mark, moment = f"HOME_SERVICE_TEST={uuid.uuid4()}", moments.uniform(*STARTING_SECONDS)
            self._interrupted_run(moment, mark, signal.SIGKILL, ROSLAUNCH)
            killed_at = time.monotonic()
            wait_until(f"nothing of it, {moment:.2f} s", lambda: not processes_with(mark), LEFT_SECONDS)  # noqa: B023
            print(
                f"killed after {moment:.2f} s of roslaunch: gone after {time.monotonic() - killed_at:.1f} s"
            )

    def _interrupted_run(self, moment, mark, number=signal.SIGINT, after=SCRIPT.name):
        """The exit code; ``moment``: wall seconds after there is a process with ``after`` in its command."""
        name, value = mark.split("=")
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)  # later: who ends may still write there
        run = subprocess.Popen(
            [str(SCRIPT), "--speed", "1", "--output", folder],
            env={**os.environ, name: value},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        wait_until(after, lambda: _is_there(after, mark), START_SECONDS)
        time.sleep(moment)
        run.send_signal(number)
        return run.wait(EXIT_SECONDS)


def _is_there(part, mark):
    return any(part in line for line in processes_with(mark))


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "interrupt", InterruptTest)
