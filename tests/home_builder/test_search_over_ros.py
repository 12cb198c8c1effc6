#!/usr/bin/env python3
"""Searches in a home that was built, over ROS: a mission that fetches, one without success, and requests."""

import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import rostest
from command import Command

from home_builder import build_home, load_plan

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = ROOT / "scripts"
WALL_SECONDS = 500.0


class SearchTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.home = self.folder / "flat"
        build_home(load_plan(ROOT / "map/flat.yaml"), self.home)

    def run_script(self, name, *words):
        """Run a script to its end; return its exit code and output."""
        command = [str(word) for word in (SCRIPTS / name, *words)]
        run = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=WALL_SECONDS)
        print(run.stdout + run.stderr)
        return run.returncode, run.stdout + run.stderr

    def run_mission(self, text):
        mission = self.folder / "mission.yaml"
        mission.write_text(text, encoding="utf-8")
        return self.run_script("home_service.sh", "--home", self.home, "--mission", mission, "--speed", "0")

    def test_objects_are_found_fetched_and_delivered(self):
        code, output = self.run_mission("deliveries: [{find: medicine}, {object: book, to: desk}]")
        self.assertEqual(code, 0)
        self.assertRegex(output, r"searching book: driving to view of")
        self.assertRegex(output, r"SUCCESS: 2 of 2 delivered, at most 0\.[0-2]\d m off, no collision")

    def test_an_object_that_is_not_there_ends_with_what_was_looked_at(self):
        objects = self.home / "objects.yaml"
        objects.write_text("book: {on: desk}\n", encoding="utf-8")
        code, output = self.run_mission("deliveries: [{find: cup}]")
        self.assertEqual(code, 1)
        self.assertRegex(output, r"FAILURE: cup was not found in \d+ looks at .*table in kitchen")

    def test_requests_search(self):
        state = self.folder / "state"
        words = ("--home", self.home, "--state", state, "--speed", "0", "--mission", self.empty_mission())
        with Command(SCRIPTS / "service.sh", *words, cwd=self.folder) as service:
            service.wait_for_line("send requests with", WALL_SECONDS)
            code, output = self.run_script("request.sh", "bring cup to desk", "--state", state, "--wait")
            self.assertEqual(code, 0)
            self.assertRegex(output, r"cup is on kitchen unit in kitchen")
            self.assertIn("cup set down at desk", output)
            code, output = self.run_script("request.sh", "find cupp", "--state", state)
            self.assertEqual(code, 2)
            self.assertIn('(did you mean "cup"?)', output)

    def empty_mission(self):
        """A home's mission is requested once at the start; one that takes no time."""
        mission = self.folder / "mission.yaml"
        mission.write_text("deliveries: [{find: keys}]", encoding="utf-8")
        return mission


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "search_over_ros", SearchTest)
