#!/usr/bin/env python3
"""Nodes of a run are killed in turn: they are respawned, the run continues, and the result lists them."""

import json
import os
import subprocess
import tempfile
import threading
import time
import unittest
from contextlib import suppress
from pathlib import Path

import psutil
import rostest
from waiting import wait_until

ROOT = Path(__file__).resolve().parents[2]
MAPPING_NODES = ("slam_gmapping", "move_base", "explore", "robot_state_publisher", "slam_gmapping")
NODES = ("amcl", "move_base", "pick_objects", "map_server", "add_markers", "robot_state_publisher", "rosout")
RUN_SECONDS = 400.0
BACK_SECONDS = 20.0
APART_SECONDS, APART_EXPLORING_SECONDS = 1.0, 5.0


class ComingBackTest(unittest.TestCase):
    def test_a_mission_survives_the_crash_of_each_of_its_nodes(self):
        with tempfile.TemporaryDirectory() as folder:
            run = Run(
                "home_service",
                "--mission",
                str(ROOT / "map/mission.yaml"),
                "--seed",
                "61",
                "--output",
                folder,
            )
            try:
                wait_until("the robot to set out", lambda: run.has_printed("driving to"), 60.0)
                for node in NODES:
                    run.kill(node)
                code = run.process.wait(RUN_SECONDS)
            finally:
                run.end()
            result = json.loads(next(Path(folder).glob("*/result.json")).read_text())
        self.assertEqual(code, 0)
        self.assertEqual([restart["node"] for restart in result["restarts"]], list(NODES))
        self.assertEqual({restart["reason"] for restart in result["restarts"]}, {"was ended by SIGKILL"})
        self.assertEqual(result["final_state"], "delivered")
        self.assertFalse(result["repeatable"])

    def test_mapping_survives_the_crash_of_its_nodes(self):
        with tempfile.TemporaryDirectory() as folder:
            run = Run("map_home", "--seed", "61", "--output", folder)
            try:
                wait_until("the explorer to begin", lambda: run.has_printed("exploring, "), 60.0)
                for node in MAPPING_NODES:
                    time.sleep(APART_EXPLORING_SECONDS)
                    run.kill(node)
                code = run.process.wait(RUN_SECONDS)
            finally:
                run.end()
            result = json.loads(next(Path(folder).glob("*/result.json")).read_text())
            logs = next(Path(folder).glob("*/log/roslaunch.log")).read_text()
            left = list(Path(folder).glob("**/*.kept*"))
        self.assertEqual(code, 0)
        self.assertEqual([restart["node"] for restart in result["restarts"]], list(MAPPING_NODES))
        self.assertEqual(logs.count("loaded a map of"), MAPPING_NODES.count("slam_gmapping"))
        self.assertEqual(left, [])

    def test_a_node_that_cannot_stay_alive_ends_the_run_with_its_reason(self):
        with tempfile.TemporaryDirectory() as folder:
            run = Run("home_service", "--output", folder)
            try:
                wait_until("the robot to set out", lambda: run.has_printed("driving to"), 60.0)
                for _ in range(4):
                    run.kill("map_server")
                code = run.process.wait(RUN_SECONDS)
            finally:
                run.end()
        self.assertEqual(code, 1)
        self.assertTrue(run.has_printed("FAILURE: map_server: was ended by SIGKILL, after 3 restarts"))


class Run:
    """A command, its output and its nodes; run at a moderate speed, so that it is not over too soon."""

    def __init__(self, command, *options):
        self.process = subprocess.Popen(
            [str(ROOT / f"scripts/{command}.sh"), "--speed", "4", *options],
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.lines = []
        threading.Thread(target=lambda: self.lines.extend(self.process.stdout), daemon=True).start()

    def has_printed(self, text):
        return any(text in line for line in list(self.lines))

    def end(self):
        """Kill the command, if it is still running, and print its output."""
        self.process.kill()
        print("".join(self.lines))

    def kill(self, node):
        """Ends the node with SIGKILL once it is there, and gives the others a moment to notice."""
        wait_until(f"{node} to be there", lambda: self._processes(node), BACK_SECONDS)
        for process in self._processes(node):
            with suppress(psutil.NoSuchProcess):  # ended with the one before
                process.kill()
        time.sleep(APART_SECONDS)

    def _processes(self, node):
        found = []
        for process in psutil.Process(self.process.pid).children(recursive=True):
            try:
                if f"__name:={node}" in process.cmdline():
                    found.append(process)
            except psutil.NoSuchProcess:
                pass
        return found


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "coming_back", ComingBackTest)
