#!/usr/bin/env python3
"""A run whose simulator is killed ends with that reason."""

import json
import tempfile
import unittest
from pathlib import Path

import rostest
from command import Command
from processes import marked_environment, processes_of, processes_with
from waiting import wait_until

ROOT = Path(__file__).resolve().parents[2]
NODE = "__name:=sim_bridge"
START_SECONDS, END_SECONDS = 120.0, 30.0
REASON = "sim_bridge: was ended by SIGKILL"


class KilledTest(unittest.TestCase):
    def test_a_mission_whose_simulator_is_killed_fails_with_that_reason(self):
        self._assert_reported("home_service.sh", "pick_objects: driving to", f"FAILURE: {REASON}")

    def test_a_map_is_not_waited_for_if_slam_was_killed(self):
        self._assert_reported("map_home.sh", " x real time", f"error: {REASON}")

    def _assert_reported(self, script, progress, verdict):
        mark, environment = marked_environment()
        command = [ROOT / "scripts" / script, "--speed", "4", "--output"]
        with tempfile.TemporaryDirectory() as parent:
            with Command(*command, parent, env=environment) as run:
                wait_until(progress, lambda: any(progress in line for line in run.lines), START_SECONDS)
                for process, words in processes_of(mark):
                    if NODE in words:
                        process.kill()
                code = run.process.wait(END_SECONDS)
            result = json.loads(next(Path(parent).glob("*/result.json")).read_text())
        last = "".join(run.lines[-3:])
        print(last)
        self.assertEqual(code, 1)
        self.assertIn(verdict, last)
        self.assertFalse(result["success"])
        self.assertTrue(result["reason"].startswith(REASON), result["reason"])
        self.assertEqual(processes_with(mark), [])


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "killed", KilledTest)
