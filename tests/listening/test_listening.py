#!/usr/bin/env python3
"""The tests' own way to hear: what is published once it says that it is connected, reaches it."""

import unittest

import rospy
import rostest
from listening import Heard
from std_msgs.msg import Int32
from waiting import wait_until


class TestListening(unittest.TestCase):
    def test_what_is_sent_to_who_has_just_connected_again_arrives(self):
        asked = rospy.Publisher("asked", Int32, queue_size=1)
        wait_until("an echo", asked.get_num_connections)
        for number in range(3):
            heard = Heard("told", Int32)
            wait_until("its connection", heard.is_connected)
            asked.publish(number)
            wait_until("the echo", lambda: heard.messages)  # noqa: B023
            self.assertEqual(heard.messages, [Int32(number)])
            heard.close()


if __name__ == "__main__":
    rospy.init_node("test_listening")
    rostest.rosrun("home_service_tests", "listening", TestListening)
