#!/usr/bin/env python3
"""A second robot follows the first on its errand, also when the first passes it on the return."""

import json
import subprocess
import tempfile
import unittest
from pathlib import Path

import rostest

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/follow.sh"
SEEDS = (44, 115)
RUN_SECONDS = 140.0


class FollowTest(unittest.TestCase):
    def test_the_follower_stays_with_its_leader(self):
        for seed in SEEDS:
            with tempfile.TemporaryDirectory() as folder:
                command = [str(SCRIPT), "--seed", str(seed), "--output", folder]
                run = subprocess.run(
                    command,
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.STDOUT,
                    text=True,
                    timeout=RUN_SECONDS,
                )
                result = json.loads(next(Path(folder).glob("*/result.json")).read_text(encoding="utf-8"))
            share, farthest = result["follower_share_near"], result["follower_farthest"]
            print(f"seed {seed}: near for {share:.0%} of the time, at most {farthest:.2f} m from the leader")
            self.assertEqual(run.returncode, 0, run.stdout)
            self.assertEqual(share, 1.0)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "follow", FollowTest)
