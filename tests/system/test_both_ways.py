#!/usr/bin/env python3
"""A seed gives the same run over ROS and in one process, to the last bit."""

import sys
import unittest
from pathlib import Path

import rostest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "benchmarks"))

import both_ways  # noqa: E402

# Control periods of the shortest errand.
LEAST_POSES = 150
# Distance of a path with exact values from that with values of messages [m].
LARGEST_DEVIATION = 0.1


class BothWaysTest(unittest.TestCase):
    def test_an_errand_is_decided_and_driven_the_same(self):
        found = both_ways.compare(seed=7)
        self.assertEqual(found.remarks, [])
        self.assertEqual(found.over_ros, found.in_one_process)
        self.assertEqual(found.over_ros[-1], "delivered")
        self.assertIsNone(found.differs_at)
        self.assertGreater(found.poses, LEAST_POSES)
        self.assertLess(found.deviation, LARGEST_DEVIATION)


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "both_ways", BothWaysTest)
