#!/usr/bin/env python3
"""A recorded run is localized again from its bag as accurately; a killed run leaves a closed bag."""

import json
import math
import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import psutil
import rosbag
import rostest
from waiting import wait_until

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
RUN_SECONDS, CLOSE_SECONDS = 140.0, 15.0
# Live and replayed errors are a few millimetres each, on so short a way.
LARGEST_RMSE = 0.02
STANDING = 0.05


class BagsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_a_recorded_run_is_localized_again_as_well(self):
        live = self._run("test_navigation.sh", "--goals", "1.5 0.3 0", "--record", "inputs", "--seed", "106")
        bag = self.folder / "live/bag/inputs_0.bag"
        with rosbag.Bag(str(bag)) as recorded:
            self.assertGreater(recorded.get_message_count("/scan"), 20)
            self.assertLess(self._distance_before_the_first_scan(recorded), STANDING)
        before = bag.read_bytes()
        replayed = self._run("replay.sh", str(self.folder / "live"))
        print(f"rmse live {live['localization_error']}, replayed {replayed['localization_error']}")
        self.assertEqual(replayed["missing"], [])
        self.assertEqual(bag.read_bytes(), before)
        for result in (live, replayed):
            self.assertLess(result["localization_error"]["rmse"], LARGEST_RMSE)
        self.assertTrue((self.folder / "replay/trajectory_estimated.tum").stat().st_size)

    def test_the_bag_is_closed_when_the_run_is_killed(self):
        output = self.folder / "output.txt"
        with output.open("w") as stream:
            run = subprocess.Popen(
                [str(SCRIPTS / "launch.sh"), "--record", "all", "--output", str(self.folder)],
                stdin=subprocess.DEVNULL,
                stdout=stream,
                start_new_session=True,
            )
        wait_until("the simulation", lambda: "the home is open" in output.read_text(), RUN_SECONDS)
        wait_until("a bag", lambda: list(self.folder.glob("*/bag/*.bag.active")), CLOSE_SECONDS)
        time.sleep(2.0)
        children = psutil.Process(run.pid).children(recursive=True)
        os.kill(run.pid, signal.SIGKILL)
        run.wait()
        wait_until("the bag's end", lambda: list(self.folder.glob("*/bag/*.bag")), CLOSE_SECONDS)
        for process in children:
            if process.is_running():
                process.terminate()
        psutil.wait_procs(children, timeout=CLOSE_SECONDS)
        with rosbag.Bag(str(next(self.folder.glob("*/bag/*.bag")))) as bag:
            print(f"{bag.get_message_count()} messages")
            self.assertGreater(bag.get_message_count("/base_pose_ground_truth"), 0)

    def _distance_before_the_first_scan(self, recorded):
        """How far the robot had come from where it starts, the origin, in metres."""
        first = next(scan.header.stamp for _, scan, _ in recorded.read_messages(["/scan"]))
        truths = (truth for _, truth, _ in recorded.read_messages(["/base_pose_ground_truth"]))
        position = next(truth for truth in truths if truth.header.stamp >= first).pose.pose.position
        return math.hypot(position.x, position.y)

    def _run(self, script, *arguments):
        """Runs a script to its success; returns its result. Its folder becomes ``live`` or ``replay``."""
        command = [str(SCRIPTS / script), *arguments, "--output", str(self.folder)]
        known = set(self.folder.iterdir())
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=RUN_SECONDS,
            check=False,
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        made = next(path for path in self.folder.iterdir() if path not in known)
        made = made.rename(self.folder / ("replay" if script == "replay.sh" else "live"))
        return json.loads((made / "result.json").read_text())


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "bags", BagsTest)
