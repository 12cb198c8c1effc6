#!/usr/bin/env python3
"""Scenarios run as a graph of ROS nodes."""

import csv
import json
import os
import signal
import subprocess
import tempfile
import unittest
import uuid
from pathlib import Path

import rostest
from processes import processes_with
from waiting import wait_until

from evaluation.verdict import ARRIVAL_TOLERANCE

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts/evaluate.sh"
# The first 25 minutes of a day in which seed 7 has two deliveries, the second with a deadline.
DAY = f"""
world: {{file: {ROOT}/map/home.world, map: {ROOT}/map/home.yaml}}
task: {{service_day: 40, mission: {ROOT}/map/mission.yaml, dock: {{x: -1.5, y: -3.2, yaw: 1.57}}}}
happens: {{boxes: 1, moves: 2, people: 1}}
limits: {{seconds: 1500}}
"""
MOVE_BASE = "__name:=move_base"
RUN_SECONDS, START_SECONDS, END_SECONDS, LEFT_SECONDS = 200.0, 90.0, 60.0, 20.0


class OverRosTest(unittest.TestCase):
    def test_a_campaign_stores_the_results_of_the_nodes(self):
        with tempfile.TemporaryDirectory() as folder:
            campaign = _campaign(folder, "home_boxes", "fields", "--seeds", "4")
            output, _ = campaign.communicate(timeout=RUN_SECONDS)
            self.assertEqual(campaign.returncode, 2, output)
            self.assertIn("the task reach runs in one process only", output)
            with (Path(folder) / "results.csv").open(encoding="utf-8") as table:
                (row,) = csv.DictReader(table)
        print(f"{row['outcome']}: at most {row['localization_max']} m off, {row['driven']} m driven")
        self.assertEqual(row["outcome"], "success", output)
        self.assertLess(float(row["localization_max"]), 0.2)
        self.assertGreater(float(row["driven"]), 0.9 * float(row["way"]))

    def test_a_day_of_service_is_run_and_judged_by_its_journal(self):
        with tempfile.TemporaryDirectory() as folder:
            scenario = Path(folder, "day.yaml")
            scenario.write_text(DAY, encoding="utf-8")
            words = [str(SCRIPT.with_name("play.sh")), str(scenario), "--seed", "7", "--over", "ros"]
            done = subprocess.run(
                [*words, "--output", folder], capture_output=True, text=True, timeout=RUN_SECONDS
            )
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            (result,) = (json.loads(path.read_text()) for path in Path(folder).glob("*/result.json"))
            (page,) = (path.read_text(encoding="utf-8") for path in Path(folder).glob("*/day.html"))
        self.assertEqual((result["score"], result["collisions"]), (1.0, []))
        self.assertIn("1 of 1 deadlines kept", result["reason"])
        self.assertGreaterEqual(result["simulated_seconds"], 1500.0)
        self.assertEqual(page.count("<td>completed</td>"), 2)
        errors = [
            delivery[f"{end}_error"] for delivery in result["deliveries"] for end in ("pickup", "dropoff")
        ]
        self.assertEqual(len(errors), 4)
        self.assertLess(max(errors), ARRIVAL_TOLERANCE)
        self.assertNotIn("was refused", page)

    def test_a_campaign_that_is_interrupted_leaves_no_process(self):
        mark = str(uuid.uuid4())
        with tempfile.TemporaryDirectory() as folder:
            campaign = _campaign(folder, "home_mission", "--seeds", "4", HOME_SERVICE_TEST=mark)
            wait_until("move_base", lambda: _has_move_base(mark), START_SECONDS)
            campaign.send_signal(signal.SIGINT)
            output, _ = campaign.communicate(timeout=END_SECONDS)
            self.assertEqual(campaign.returncode, 130, output)
            wait_until("the end of all nodes", lambda: not processes_with(mark), LEFT_SECONDS)


def _campaign(folder, *words, **environment):
    return subprocess.Popen(
        [str(SCRIPT), *words, "--over", "ros", "--output", folder],
        env={**os.environ, **environment},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def _has_move_base(mark):
    return any(MOVE_BASE in command for command in processes_with(mark))


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "over_ros", OverRosTest)
