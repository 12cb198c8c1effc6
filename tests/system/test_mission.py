#!/usr/bin/env python3
"""The whole mission in the whole graph, judged against ground truth."""

import time
import unittest

import rospy
import rostest

from evaluation.consumers.referee import Referee
from evaluation.ros.run_topics import observe
from evaluation.verdict import ERRAND, MARKERS, judge
from planar.maps.places import load_pickup_and_dropoff

SIMULATED_DEADLINE = 240.0
WALL_DEADLINE = 240.0
EXPECTED = {ERRAND, MARKERS}


class MissionTest(unittest.TestCase):
    def test_the_object_is_fetched_and_delivered(self):
        places = {place.name: place for place in load_pickup_and_dropoff(rospy.get_param("~zones_file"))}
        referee = Referee(places, print)
        observe(referee)
        wall_deadline = time.monotonic() + WALL_DEADLINE
        while not referee.mission_record.is_complete(EXPECTED):
            self.assertLess(referee.simulated_seconds, SIMULATED_DEADLINE, f"state '{referee.state}'")
            self.assertLess(time.monotonic(), wall_deadline, f"state '{referee.state}'")
            time.sleep(0.05)
        print(f"errors {referee.mission_record.position_errors}, {referee.simulated_seconds:.1f} s simulated")
        verdict = judge(referee.mission_record, EXPECTED)
        self.assertTrue(verdict.success, verdict.reason)


if __name__ == "__main__":
    rospy.init_node("test_mission")
    rostest.rosrun("home_service_tests", "mission", MissionTest)
