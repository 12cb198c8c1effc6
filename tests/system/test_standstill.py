#!/usr/bin/env python3
"""Runs that cannot continue end with the reason."""

import os
import re
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path

import rostest
from processes import marked_environment, processes_of, processes_with
from waiting import wait_until

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/home_service.sh"
MARK, ENVIRONMENT = marked_environment()
TIMEOUT, RUN_SECONDS = 75.0, 150.0
LOST_ODOMETRY = "faults: [{kind: odometry_stopped, start: 8.0}]\n"


class StandstillTest(unittest.TestCase):
    def test_a_pause_without_end_is_reported(self):
        code, output = self.run_to_its_end("--speed", "2", "--timeout", "25", do=self.pause)
        self.assertEqual(code, 1)
        self.assertRegex(output, r"time stands still at [\d.]+ s: the simulation is paused")
        self.assertRegex(output, r"FAILURE: not done within .*; simulated time stands still at")

    def test_a_stopped_node_is_named_when_time_stops_and_at_the_end(self):
        code, output = self.run_to_its_end("--timeout", "25", do=lambda _: self.stop("move_base"))
        self.assertEqual(code, 1)
        self.assertRegex(output, r"time stands still at [\d.]+ s: the simulator waits for move_base")
        self.assertRegex(output, r"FAILURE: not done within .*; no answer of move_base")
        self.assertEqual(processes_with(MARK), [])

    def test_a_stopped_simulator_is_named(self):
        code, output = self.run_to_its_end("--timeout", "25", do=lambda _: self.stop("sim_bridge"))
        self.assertEqual(code, 1)
        self.assertRegex(output, r"time stands still at [\d.]+ s: the simulator does not answer")
        self.assertRegex(output, r"FAILURE: not done within .*; no answer of sim_bridge")
        self.assertEqual(processes_with(MARK), [])

    def test_odometry_that_stops_for_good_ends_the_run_early(self):
        """Three times the patience of move_base, at as many times real time as ever."""
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as faults:
            faults.write(LOST_ODOMETRY)
            faults.flush()
            code, output = self.run_to_its_end("--faults", faults.name)
        self.assertEqual(code, 1)
        self.assertRegex(output, r"FAILURE: place pickup not reached .*odometry: none for [\d.]+ s")
        self.assertNotIn("no progress of", output, "or amcl, without odometry, would hold up time")

    def run_to_its_end(self, *options, do=lambda folder: None):
        """Exit code and what was output; ``do`` is done with the folder of runs when the robot sets out."""
        with tempfile.TemporaryDirectory() as folder:
            run = subprocess.Popen(
                [str(SCRIPT), "--output", folder, *options],
                env=ENVIRONMENT,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
            output = []
            reader = threading.Thread(target=lambda: output.extend(run.stdout), daemon=True)
            reader.start()
            try:
                wait_until("the robot to set out", lambda: "driving to" in "".join(output), TIMEOUT)
                do(Path(folder))
                code = run.wait(RUN_SECONDS)
            finally:
                run.kill()
            reader.join(TIMEOUT)
        print("".join(output))
        return code, "".join(output)

    @staticmethod
    def stop(node):
        """By SIGSTOP, upon which it does nothing any more, but is there."""
        for process, words in processes_of(MARK):
            if f"__name:={node}" in words:
                process.suspend()

    @staticmethod
    def pause(folder):
        """By the service, at the master of the run, as written in its log."""
        log = next(folder.glob("*/log/roslaunch.log")).read_text()
        environment = {**os.environ, "ROS_MASTER_URI": re.search(r"ROS_MASTER_URI=(http://[\d.:]+)", log)[1]}
        command = ["rosservice", "call", "/gazebo/pause_physics"]
        subprocess.run(command, env=environment, check=True, timeout=30.0)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "standstill", StandstillTest)
