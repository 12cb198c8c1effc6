#!/usr/bin/env python3
"""The service with a mock move_base that reaches every goal: requests over ROS and HTTP, and kills."""

import os
import random
import shutil
import signal
import time
import unittest
from pathlib import Path

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from home_service_msgs.msg import DeliverAction, DeliverGoal, Delivery, MissionState
from home_service_msgs.srv import AddDelivery
from move_base_msgs.msg import MoveBaseAction
from nav_msgs.msg import OccupancyGrid
from processes import node_pid
from std_msgs.msg import String
from waiting import wait_until

from planar import SettingsError
from planar_ros.calls.actions import goal_is_over, server_is_ready
from service.http.client import RequestRefusedError, ServiceClient

DRIVE_SECONDS = 0.1
KILLS = 6


class ReachedGoals:
    """Mock move_base."""

    def __init__(self):
        self._server = actionlib.SimpleActionServer("move_base", MoveBaseAction, self._execute, False)
        self._server.start()

    def _execute(self, _goal):
        time.sleep(DRIVE_SECONDS)
        self._server.set_succeeded(text="Goal reached.")


class ServiceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.move_base, cls.carried = ReachedGoals(), []
        cls.map = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        grid = OccupancyGrid(data=[0] * 40_000)
        grid.info.resolution, grid.info.width, grid.info.height = 0.1, 200, 200
        grid.info.origin.position.x = grid.info.origin.position.y = -10.0
        grid.info.origin.orientation.w = 1.0
        cls.map.publish(grid)
        rospy.Subscriber("pick_objects/mission_state", MissionState, cls._keep_state)
        cls.folder = Path(rospy.get_param("/service/state_folder"))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    @classmethod
    def _keep_state(cls, message):
        for state in message.objects:
            if not cls.carried or (state.name, state.is_carried) not in cls.carried[-20:]:
                cls.carried.append((state.name, state.is_carried))

    def setUp(self):
        wait_until("the service", lambda: (self.folder / "service.json").exists(), 60.0)
        self.client = ServiceClient(self.folder)

    def test_the_action_delivers(self):
        client = actionlib.SimpleActionClient("deliver", DeliverAction)
        wait_until("the action", lambda: server_is_ready(client))
        client.send_goal(DeliverGoal(deliveries=[Delivery("errand", "parcel", "pickup", "dropoff")]))
        wait_until("the end", lambda: goal_is_over(client), 30.0)
        self.assertEqual(client.get_state(), GoalStatus.SUCCEEDED)
        self.assertEqual(client.get_result().reason, "1 of 1 delivered")
        client.send_goal(DeliverGoal(deliveries=[Delivery("errand", "parcel", "attic", "dropoff")]))
        wait_until("the refusal", lambda: goal_is_over(client))
        self.assertEqual(client.get_state(), GoalStatus.ABORTED)
        self.assertIn("attic", client.get_result().reason)

    def test_requests_come_by_topic_and_service(self):
        topic = rospy.Publisher("service/request", String, queue_size=5)
        wait_until("a subscriber", lambda: topic.get_num_connections() > 0)
        for text in ("go dropoff", '{"text": "go pickup", "id": "by-topic"}', "{", "fly home"):
            topic.publish(text)
        add = rospy.ServiceProxy("pick_objects/add_delivery", AddDelivery)
        self.assertTrue(add(Delivery("", "box", "pickup", "dropoff")).success)
        self.assertIn("attic", add(Delivery("", "box", "attic", "dropoff")).message)
        wait_until("the end", lambda: self._ended("by-topic") == "completed", 30.0)

    def test_z_a_killed_service_goes_on(self):
        chance = random.Random(0)
        names = [f"killed-{number}" for number in range(12)]
        for number, name in enumerate(names):
            text = f"deliver item{number} from pickup to dropoff"
            self.client.submit({"text": text, "id": name}, patience=20.0)
        for _ in range(KILLS):
            time.sleep(chance.uniform(0.0, 1.0))
            self._kill()
        wait_until("the end", lambda: all(self._ended(name) for name in names), 90.0)
        history = [task for task in self.client.call("GET", "/history") if task["booking"]["id"] in names]
        self.assertEqual(sorted(task["booking"]["id"] for task in history), sorted(names))
        self.assertEqual({task["status"] for task in history}, {"completed"})
        for number in range(12):
            self.assertEqual(self.carried.count((f"item{number}", True)), 1)

    def _ended(self, name):
        try:
            task = self.client.call("GET", f"/tasks/{name}")
        except (RequestRefusedError, SettingsError):
            return ""
        return task["status"] if task["status"] not in ("queued", "underway") else ""

    def _kill(self):
        pid = node_pid("/service")
        if pid is None:
            return
        (self.folder / "service.json").unlink(missing_ok=True)
        os.kill(pid, signal.SIGKILL)
        wait_until("another process", lambda: (self.folder / "service.json").exists(), 60.0)


if __name__ == "__main__":
    rospy.init_node("test_requests")
    rostest.rosrun("home_service_tests", "requests", ServiceTest)
