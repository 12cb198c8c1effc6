#!/usr/bin/env python3
"""The service in the simulated home: charging before a request, two docks, one behind a wall, none."""

import shutil
import unittest
from pathlib import Path

import rospy
import rostest
from gazebo_msgs.srv import DeleteModel, SpawnModel
from geometry_msgs.msg import Point, Pose, Quaternion
from kobuki_msgs.msg import SensorState
from recording import MessageRecorder
from waiting import wait_until

from service.http.client import ServiceClient
from sim_bridge.sdf.reader import MODELS

# Wall-clock time for a request, on a busy machine [s].
PATIENCE = 240.0
FACING_NORTH = Quaternion(z=0.7071, w=0.7071)
WALL = """<sdf version="1.6"><model name="wall"><static>true</static><link name="link">
<collision name="collision"><pose>0 0 0.5 0 0 0</pose><geometry><box><size>1.6 0.1 1</size></box></geometry>
</collision></link></model></sdf>"""


class ServiceDockingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.core = MessageRecorder("mobile_base/sensors/core", SensorState)
        cls.folder = Path(rospy.get_param("/service/state_folder"))
        wait_until("the service", lambda: (cls.folder / "service.json").exists(), PATIENCE)
        cls.client = ServiceClient(cls.folder)
        cls.add = rospy.ServiceProxy("/gazebo/spawn_sdf_model", SpawnModel)
        cls.remove = rospy.ServiceProxy("/gazebo/delete_model", DeleteModel)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def test_docks(self):
        rospy.wait_for_service("/move_base/zones/dock", PATIENCE)  # its housing, to keep out of
        self.a_low_battery_is_charged_before_the_request()
        self.of_two_docks_one_is_taken()
        self.a_dock_behind_a_wall_is_stated()
        self.a_dock_that_is_gone_is_stated()

    def a_low_battery_is_charged_before_the_request(self):
        self.client.submit({"text": "go pickup", "id": "errand"})
        wait_until("charging", lambda: self.state()["is_docked"], PATIENCE)
        self.assertEqual(self.core.messages[-1].charger, SensorState.DOCKING_CHARGING)
        self.assertEqual(self.task("errand")["status"], "queued")
        self.assertEqual(self.end_of("errand")["status"], "completed")
        self.assertGreater(self.state()["charge"], 0.2)

    def of_two_docks_one_is_taken(self):
        self.add("second", (MODELS / "kobuki_dock/model.sdf").read_text(), "", north_at(0.3, -3.2), "")
        self.assertEqual(self.request("dock", "two")["status"], "completed")
        self.assertEqual(self.core.messages[-1].charger, SensorState.DOCKING_CHARGING)
        self.assertEqual(self.request("go dropoff", "away")["status"], "completed")
        self.remove("second")

    def a_dock_behind_a_wall_is_stated(self):
        self.add("wall", WALL, "", Pose(Point(x=-1.5, y=-2.9), Quaternion(w=1.0)), "")
        task = self.request("dock", "walled")
        self.assertEqual(task["status"], "failed")
        self.assertRegex(task["reason"], "not docked: Aborted: FAILED_TO_(STAGE|DETECT_DOCK|CONTROL)")
        self.remove("wall")

    def a_dock_that_is_gone_is_stated(self):
        self.remove("dock")
        task = self.request("dock", "gone")
        self.assertEqual(task["status"], "failed")
        self.assertIn("no signal of a dock", task["reason"])

    def request(self, text, name):
        """Send a request and return its task at the end."""
        self.client.submit({"text": text, "id": name})
        return self.end_of(name)

    def end_of(self, name):
        wait_until(
            f"the end of {name}", lambda: self.task(name)["status"] not in ("queued", "underway"), PATIENCE
        )
        return self.task(name)

    def task(self, name):
        return self.client.call("GET", f"/tasks/{name}")

    def state(self):
        return self.client.call("GET", "/state")


def north_at(x, y):
    return Pose(Point(x=x, y=y), FACING_NORTH)


if __name__ == "__main__":
    rospy.init_node("test_service_docking")
    rostest.rosrun("home_service_tests", "service_docking", ServiceDockingTest)
