#!/usr/bin/env python3
"""The collision monitor over ROS: a robot steered at walls never touches one."""

import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from move_base_client import MessageRecorder
from nav_msgs.msg import Odometry
from std_msgs.msg import String
from waiting import wait_until

DRIVES = [(0.6, 0.0, 8.0), (-0.4, 0.6, 8.0), (0.6, -1.0, 6.0), (0.5, 0.3, 8.0), (-0.5, 0.0, 8.0)]


class TestCollisionMonitor(unittest.TestCase):
    def test_a_blind_driver_hits_nothing(self):
        state, odometry = (
            MessageRecorder("collision_monitor/state", String),
            MessageRecorder("odom", Odometry),
        )
        contacts = MessageRecorder("contacts", String)
        publisher = rospy.Publisher("cmd_vel_raw", Twist, queue_size=1)
        odometry.wait()
        wait_until("the monitor", publisher.get_num_connections)
        for v, omega, seconds in DRIVES:
            command = Twist()
            command.linear.x, command.angular.z = v, omega
            until = rospy.get_time() + seconds
            while rospy.get_time() < until:
                publisher.publish(command)
                rospy.sleep(0.1)
        touched = [message.data for message in contacts.messages if message.data]
        self.assertEqual(touched, [])
        states = {message.data for message in state.messages}
        self.assertLessEqual({"clear", "slowed", "stopped"}, states)


if __name__ == "__main__":
    rospy.init_node("collision_monitor_test")
    rostest.rosrun("home_service_tests", "collision_monitor", TestCollisionMonitor)
