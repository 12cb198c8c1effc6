#!/usr/bin/env python3
"""A run whose simulator is killed says so, and ends."""

import json
import tempfile
import unittest
from pathlib import Path

import rostest
from command import Command
from processes import marked_environment, processes_of, processes_with

ROOT = Path(__file__).resolve().parents[2]
NODE = "__name:=sim_bridge"
END_SECONDS = 30.0
REASON = "sim_bridge: was ended by SIGKILL"


class KilledTest(unittest.TestCase):
    def test_a_mission_whose_simulator_is_killed_ends_with_that_for_its_reason(self):
        mark, environment = marked_environment()
        command = [ROOT / "scripts/home_service.sh", "--speed", "4", "--output"]
        with tempfile.TemporaryDirectory() as parent:
            with Command(*command, parent, env=environment) as run:
                run.told("pick_objects: driving to")
                for process, words in processes_of(mark):
                    if NODE in words:
                        process.kill()
                code = run.process.wait(END_SECONDS)
            result = json.loads(next(Path(parent).glob("*/result.json")).read_text())
        last = "".join(run.lines[-3:])
        print(last)
        self.assertEqual(code, 1)
        self.assertIn(f"FAILURE: {REASON}", last)
        self.assertFalse(result["success"])
        self.assertTrue(result["reason"].startswith(REASON), result["reason"])
        self.assertEqual(processes_with(mark), [])


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "killed", KilledTest)
