#!/usr/bin/env python3
"""A delivery asked for at the page, by a person who sees how it goes; judged by ground truth."""

import os
import tempfile
import time
import unittest
from pathlib import Path

import rosgraph
import rospy
import rostest
from browser import Browser
from home_service_msgs.msg import DeliveryState, MissionState
from nav_msgs.msg import Odometry
from waiting import wait_until

from cockpit.process import FREE_PORT, CockpitProcess
from cockpit.ros.graph import CATALOGUE_SECONDS
from planar.maps.places import load_places
from planar_ros.messages.conversion import pose2_from_msg

ZONES = Path(__file__).resolve().parents[2] / "map/zones.yaml"
PICTURES = os.environ.get("COCKPIT_PICTURES")
ARRIVAL, MISSION_SECONDS = 0.25, 150.0


class CockpitMissionTest(unittest.TestCase):
    def test_a_delivery_is_asked_for_joined_and_cancelled(self):
        self.newest, self.brought_to = {}, None
        self.subscribe("/pick_objects/mission_state", MissionState)
        self.subscribe("/base_pose_ground_truth", Odometry)
        with tempfile.TemporaryDirectory() as folder, Browser() as browser:
            cockpit = CockpitProcess(FREE_PORT, Path(folder) / "cockpit.log")
            self.addCleanup(cockpit.close)
            self.page = browser.open(cockpit.url, 1400, 1400)
            self.page.wait_for("/scan", "/map", "/zones", seconds=90.0)
            self.assertTrue(self.page.is_ticked("/zones"))
            self.page.click("Drive")
            wait_until("a robot that takes missions", takes_missions, 60.0)
            time.sleep(CATALOGUE_SECONDS + 0.5)
            self.assertEqual([self.page.value_of(end) for end in ("From", "To")], ["pickup", "dropoff"])
            self.request("cup", "pickup", "pickup")
            self.page.wait_for("The mission was refused: delivery 1: cup is at pickup already")
            self.request("cup", "pickup", "dropoff")
            wait_until("the first delivery", lambda: self.states() == [DeliveryState.FETCHING], 60.0)
            self.request("cup", "dropoff", "pickup")
            wait_until("the second one", lambda: len(self.states()) == 2)
            wait_until("the cup", lambda: self.brought_to is not None, MISSION_SECONDS)
            self.page.click("Cancel the mission")  # while the second one is under way
            error = self.brought_to.distance_to(load_places(ZONES)["dropoff"].pose)
            print(f"{error:.3f} m off where it was to be brought")
            self.assertLess(error, ARRIVAL)
            self.page.wait_for("delivered")
            if PICTURES:
                self.page.screenshot(Path(PICTURES) / "mission.png")
            wait_until("the end", lambda: self.states()[1] == DeliveryState.CANCELLED, MISSION_SECONDS)
            self.page.wait_for("cancelled")
            self.assertNotIn("refused", self.page.text())
            self.assertEqual(self.page.errors, [])

    def request(self, name, source, destination):
        self.page.fill_in("Object", name)
        self.page.choose("From", source)
        self.page.choose("To", destination)
        self.page.click("Deliver it")
        self.page.wait_for(f"{name}: from {source} to {destination}")

    def subscribe(self, topic, kind):
        rospy.Subscriber(topic, kind, lambda message: self.keep(topic, message), queue_size=50)

    def keep(self, topic, message):
        self.newest[topic] = message
        if self.brought_to is None and self.states()[:1] == [DeliveryState.DELIVERED]:
            self.brought_to = pose2_from_msg(self.newest["/base_pose_ground_truth"].pose.pose)

    def states(self):
        mission = self.newest.get("/pick_objects/mission_state", MissionState())
        return [each.state for each in mission.deliveries]


def takes_missions():
    _, subscribed, _ = rosgraph.Master("/test").getSystemState()
    return any(topic == "/deliver/goal" for topic, _ in subscribed)


if __name__ == "__main__":
    rospy.init_node("test_cockpit_mission")
    rostest.rosrun("home_service_tests", "mission_in_browser", CockpitMissionTest)
