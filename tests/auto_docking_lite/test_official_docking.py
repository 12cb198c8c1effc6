#!/usr/bin/env python3
"""The unmodified kobuki_auto_docking docks at the simulated dock; skipped where it is not installed."""

import subprocess
import unittest

import actionlib
import rospkg
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from kobuki_msgs.msg import AutoDockingAction, AutoDockingGoal, SensorState
from recording import MessageRecorder
from waiting import wait_until

REMAPPINGS = (
    "dock_drive/odom:=odom",
    "dock_drive/core:=mobile_base/sensors/core",
    "dock_drive/dock_ir:=mobile_base/sensors/dock_ir",
    "dock_drive/velocity:=mobile_base/commands/velocity",
)
NODELET = "kobuki_auto_docking/AutoDockingNodelet"
SECONDS = 200.0


def is_installed(package):
    try:
        return bool(rospkg.RosPack().get_path(package))
    except rospkg.ResourceNotFound:
        return False


@unittest.skipUnless(is_installed("kobuki_auto_docking"), "kobuki_auto_docking is not installed")
class TestOfficialDocking(unittest.TestCase):
    def setUp(self):
        command = ["rosrun", "nodelet", "nodelet", "standalone", NODELET, "__name:=dock_drive", *REMAPPINGS]
        self.node = subprocess.Popen(command)

    def tearDown(self):
        self.node.terminate()
        self.node.wait(10.0)

    def test_it_arrives_and_the_robot_charges(self):
        core = MessageRecorder("mobile_base/sensors/core", SensorState)
        client = actionlib.SimpleActionClient("dock_drive_action", AutoDockingAction)
        wait_until("the action", lambda: client.wait_for_server(rospy.Duration(0.1)))
        states = []
        client.send_goal(AutoDockingGoal(), feedback_cb=lambda feedback: states.append(feedback.state))
        wait_until(
            "the end", lambda: client.get_state() not in (GoalStatus.PENDING, GoalStatus.ACTIVE), SECONDS
        )
        self.assertEqual(client.get_result().text, "Arrived on docking station successfully.")
        self.assertTrue({"SCAN", "ALIGNED_NEAR", "DOCKED_IN"} <= set(states), set(states))
        self.assertEqual(core.messages[-1].charger, SensorState.DOCKING_CHARGING)


if __name__ == "__main__":
    rospy.init_node("test_official_docking")
    rostest.rosrun("home_service_tests", "official_docking", TestOfficialDocking)
