#!/usr/bin/env python3
"""A run whose simulation is paused for ever says so, and ends with that for its reason."""

import os
import re
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path

import rostest
from waiting import wait_until

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/home_service.sh"
TIMEOUT, RUN_SECONDS = 75.0, 150.0


class StandstillTest(unittest.TestCase):
    def test_a_pause_for_ever_is_told(self):
        with tempfile.TemporaryDirectory() as folder:
            run = subprocess.Popen(
                [str(SCRIPT), "--speed", "2", "--timeout", str(TIMEOUT), "--output", folder],
                env={**os.environ, "PYTHONUNBUFFERED": "1"},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
            said = []
            threading.Thread(target=lambda: said.extend(run.stdout), daemon=True).start()
            try:
                wait_until("the robot to set out", lambda: "driving to" in "".join(said), TIMEOUT)
                self.pause(Path(folder))
                code = run.wait(RUN_SECONDS)
            finally:
                run.kill()
        print("".join(said))
        self.assertEqual(code, 1)
        self.assertRegex("".join(said), r"time stands still at [\d.]+ s: the simulation is paused")
        self.assertRegex("".join(said), r"FAILURE: not done within .*; simulated time stands still at")

    @staticmethod
    def pause(folder):
        """By the service, at the master of the run, which its log tells."""
        log = next(folder.glob("*/log/roslaunch.log")).read_text()
        environment = {**os.environ, "ROS_MASTER_URI": re.search(r"ROS_MASTER_URI=(http://[\d.:]+)", log)[1]}
        command = ["rosservice", "call", "/gazebo/pause_physics"]
        subprocess.run(command, env=environment, check=True, timeout=30.0)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "standstill", StandstillTest)
