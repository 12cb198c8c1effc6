#!/usr/bin/env python3
"""A message that is published once a MessageRecorder is connected reaches it."""

import unittest

import rospy
import rostest
from recording import MessageRecorder
from std_msgs.msg import Int32
from waiting import wait_until


class TestMessageRecorder(unittest.TestCase):
    def test_a_message_reaches_a_recorder_that_has_just_connected_again(self):
        numbers = rospy.Publisher("numbers", Int32, queue_size=1)
        wait_until("an echo", numbers.get_num_connections)
        for number in range(3):
            recorder = MessageRecorder("echo", Int32)
            wait_until("its connection", recorder.is_connected)
            numbers.publish(number)
            wait_until("the echo", lambda: recorder.messages)  # noqa: B023
            self.assertEqual(recorder.messages, [Int32(number)])
            recorder.close()


if __name__ == "__main__":
    rospy.init_node("test_message_recorder")
    rostest.rosrun("home_service_tests", "recording", TestMessageRecorder)
