#!/usr/bin/env python3
"""Docking over ROS by the action of kobuki_auto_docking, and what the battery states meanwhile."""

import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist
from kobuki_msgs.msg import AutoDockingAction, AutoDockingGoal, DockInfraRed, PowerSystemEvent, SensorState
from recording import MessageRecorder
from sensor_msgs.msg import BatteryState
from waiting import wait_until

SUCCESS = "Arrived on docking station successfully."


class TestDocking(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.core = MessageRecorder("mobile_base/sensors/core", SensorState)
        cls.signals = MessageRecorder("mobile_base/sensors/dock_ir", DockInfraRed)
        cls.events = MessageRecorder("mobile_base/events/power_system", PowerSystemEvent)
        cls.battery = MessageRecorder("battery_state", BatteryState)
        cls.diagnostics = MessageRecorder("/diagnostics", DiagnosticArray)
        cls.velocity = MessageRecorder("mobile_base/commands/velocity", Twist)
        cls.dock = actionlib.SimpleActionClient("dock_drive_action", AutoDockingAction)
        cls.undock = actionlib.SimpleActionClient("dock_drive_undock_action", AutoDockingAction)
        for client in (cls.dock, cls.undock):
            wait_until("the action", lambda: client.wait_for_server(rospy.Duration(0.1)))  # noqa: B023

    def execute(self, client, until=GoalStatus.SUCCEEDED):
        """Send a goal and wait for its end; return the text of the result and the states on the way."""
        states = []

        def on_feedback(feedback):
            if not states or states[-1] != feedback.state:
                states.append(feedback.state)

        client.send_goal(AutoDockingGoal(), feedback_cb=on_feedback)
        self.wait_for_end(client, until, 120.0)
        return client.get_result().text, states

    def wait_for_end(self, client, state, seconds=30.0):
        """Wait for the result, which comes on another connection than the status."""
        wait_until("the end", lambda: client.get_state() in (state, GoalStatus.ABORTED), seconds)
        self.assertEqual(client.get_state(), state, client.get_goal_status_text())
        wait_until("the result", lambda: client.get_result() is not None)

    def test_a_day_at_the_dock(self):
        self.dock_and_charge()
        self.undock_and_discharge()
        self.cancel()

    def dock_and_charge(self):
        wait_until("the state", lambda: self.core.messages)
        self.assertEqual(self.core.messages[-1].charger, SensorState.DISCHARGING)
        self.assertTrue(130 < self.core.messages[-1].battery < 165, self.core.messages[-1].battery)
        text, states = self.execute(self.dock)
        self.assertEqual(text, SUCCESS)
        self.assertEqual(states[0], "SCAN")
        self.assertIn("ALIGNED_NEAR", states)
        self.assertEqual(len(self.signals.messages[-1].data), 3)
        wait_until("charging", lambda: self.core.messages[-1].charger == SensorState.DOCKING_CHARGING)
        wait_until("the event", lambda: self.events.messages)
        self.assertEqual(self.events.messages[-1].event, PowerSystemEvent.PLUGGED_TO_DOCKBASE)
        charging = BatteryState.POWER_SUPPLY_STATUS_CHARGING
        wait_until("the battery", lambda: self.battery.messages[-1].power_supply_status == charging)
        battery = self.battery.messages[-1]
        self.assertTrue(battery.present and battery.current > 0.0 and 0.5 < battery.percentage < 0.7)
        wait_until("diagnostics", lambda: "mobile_base: Battery" in self.diagnosed())

    def diagnosed(self):
        """Return the names of all statuses; several nodes publish them."""
        return {status.name for message in self.diagnostics.messages for status in message.status}

    def undock_and_discharge(self):
        text, _ = self.execute(self.undock)
        self.assertEqual(text, "Left the docking station.")
        wait_until("discharging", lambda: self.core.messages[-1].charger == SensorState.DISCHARGING)
        unplugged = PowerSystemEvent.UNPLUGGED
        wait_until("the event", lambda: self.events.messages[-1].event == unplugged)

    def cancel(self):
        self.dock.send_goal(AutoDockingGoal())
        wait_until("the goal", lambda: self.dock.get_state() == GoalStatus.ACTIVE)
        self.dock.cancel_goal()
        self.wait_for_end(self.dock, GoalStatus.PREEMPTED)
        self.assertEqual(self.dock.get_result().text, "Cancelled: Cancel requested.")
        wait_until("the stop", lambda: self.velocity.messages[-1] == Twist())  # on another connection


if __name__ == "__main__":
    rospy.init_node("test_docking")
    rostest.rosrun("home_service_tests", "docking", TestDocking)
