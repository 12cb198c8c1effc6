#!/usr/bin/env python3
"""Missions of a serving and respawned pick_objects, with a mock move_base that reaches every goal."""

import os
import signal
import subprocess
import tempfile
import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalID, GoalStatus
from home_service_msgs.msg import DeliverAction, DeliverGoal, Delivery, MissionState
from home_service_msgs.srv import CancelDelivery
from move_base_msgs.msg import MoveBaseAction
from processes import node_pid
from waiting import wait_until

from planar_ros.calls.actions import MAX_CLOCK_SKEW, goal_is_over, server_is_ready

CHECKPOINT = "/with_file/checkpoint/value"
FOUR = """\
settings: {pickup_seconds: 0.0}
deliveries:
  - {name: a, object: cup, from: pickup, to: dropoff}
  - {name: b, object: book, from: pickup, to: dropoff}
  - {name: c, object: key, from: pickup, to: dropoff}
  - {name: d, object: letter, from: pickup, to: dropoff}
"""


class ReachedGoals:
    """Mock move_base; while ``is_blocked``, goals are pursued without end."""

    def __init__(self, name):
        self.count = 0
        self.is_blocked = False
        self._server = actionlib.SimpleActionServer(name, MoveBaseAction, self._execute, False)
        self._server.start()

    def _execute(self, _goal):
        self.count += 1
        while self.is_blocked:
            if self._server.is_preempt_requested():
                self._server.set_preempted()
                return
            time.sleep(0.01)
        self._server.set_succeeded(text="Goal reached.")


class ServedTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.move_base, cls.other = ReachedGoals("move_base"), ReachedGoals("other/move_base")
        cls.client = actionlib.SimpleActionClient("deliver", DeliverAction)
        cls.states = {}
        for node in ("pick_objects", "with_file"):
            rospy.Subscriber(f"{node}/mission_state", MissionState, cls._keep_state, callback_args=node)

    @classmethod
    def _keep_state(cls, message, node):
        cls.states[node] = message

    def setUp(self):
        self.move_base.is_blocked = False
        wait_until("the action", lambda: server_is_ready(self.client))

    def test_the_same_mission_sent_twice_is_carried_out_twice(self):
        for _ in range(2):
            before = self.move_base.count
            self.assertEqual(self._deliver(), GoalStatus.SUCCEEDED)
            self.assertEqual(self.move_base.count - before, 2)

    def test_a_cancelled_mission_that_is_sent_again_is_carried_out(self):
        self.move_base.is_blocked = True
        before = self.move_base.count
        self.client.send_goal(self._goal())
        wait_until("a goal", lambda: self.move_base.count > before)
        self.client.cancel_goal()
        self.assertEqual(self._end(), GoalStatus.PREEMPTED)
        self.move_base.is_blocked = False
        self.assertEqual(self._deliver(), GoalStatus.SUCCEEDED)

    def test_one_of_four_delivered_and_three_cancelled_is_no_success(self):
        self.move_base.is_blocked = True
        before = self.move_base.count
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write(FOUR)
            file.flush()
            command = ["rosrun", "pick_objects", "deliver", file.name]
            deliver = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
            wait_until("a goal", lambda: self.move_base.count > before)
            cancel = rospy.ServiceProxy("pick_objects/cancel_delivery", CancelDelivery)
            for name in "bcd":
                self.assertTrue(cancel(name).success)
            self.move_base.is_blocked = False
            output = deliver.communicate(timeout=20)[0]
        self.assertIn("1 of 4 delivered, 3 cancelled", output)
        self.assertEqual(deliver.returncode, 1)

    def test_a_stray_cancel_stamped_far_ahead_does_not_disable_the_action(self):
        cancels = rospy.Publisher("deliver/cancel", GoalID, queue_size=1)
        wait_until("a subscriber", lambda: cancels.get_num_connections() > 0)
        cancels.publish(GoalID(stamp=rospy.Time.now() + rospy.Duration(10**9)))
        time.sleep(MAX_CLOCK_SKEW.to_sec() + 0.5)
        self.assertEqual(self._deliver(), GoalStatus.SUCCEEDED)

    def test_z_a_mission_of_a_file_that_is_over_is_not_carried_out_again_after_a_crash(self):
        self._wait_for_the_file("delivered")
        self.assertEqual(self.other.count, 4)
        self._kill()
        self._wait_for_the_file("delivered")
        self.assertEqual(self.other.count, 4)

    def test_zz_after_a_crash_a_checkpoint_of_another_shape_is_ignored(self):
        self._wait_for_the_file("delivered")
        before = self.other.count
        rospy.set_param(CHECKPOINT, '{"mission": "two errands", "jobs": 3}')
        self._kill()
        self._wait_for_the_file("delivered")
        self.assertEqual(self.other.count - before, 4)

    def _kill(self):
        pid = node_pid("/with_file")
        self.states.pop("with_file", None)
        os.kill(pid, signal.SIGKILL)
        wait_until("another process", lambda: node_pid("/with_file") not in (None, pid))

    def _wait_for_the_file(self, state):
        wait_until("the mission of the file", lambda: "with_file" in self.states)
        wait_until(f"its state {state}", lambda: self.states["with_file"].state == state)

    def _goal(self):
        return DeliverGoal(deliveries=[Delivery("errand", "parcel", "pickup", "dropoff")])

    def _deliver(self):
        self.client.send_goal(self._goal())
        return self._end()

    def _end(self):
        wait_until("the end", lambda: goal_is_over(self.client))
        return self.client.get_state()


if __name__ == "__main__":
    rospy.init_node("test_served")
    rostest.rosrun("home_service_tests", "served", ServedTest)
