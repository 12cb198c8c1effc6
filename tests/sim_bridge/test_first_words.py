#!/usr/bin/env python3
"""A node in step has the static transforms of others from its first moment on."""

import unittest

import rospy
import rostest
from tf2_msgs.msg import TFMessage
from waiting import wait_until

from planar_ros.step import Step


class TestFirstWords(unittest.TestCase):
    def test_static_transforms_are_there_at_the_first_moment_however_late_their_node_starts(self):
        frames, moments = set(), []
        step = Step.of_node()

        def keep(message):
            frames.update(each.child_frame_id for each in message.transforms)

        rospy.Subscriber("/tf_static", TFMessage, keep, queue_size=10)
        step.at_moments(lambda: moments.append(frozenset(frames)))
        step.join()
        wait_until("moments", lambda: len(moments) > 5, 30.0)
        self.assertIn("late", moments[0])
        self.assertIn("base_link", moments[0], "of the robot_state_publisher")


if __name__ == "__main__":
    rospy.init_node("first_words")
    rostest.rosrun("home_service_tests", "first_words", TestFirstWords)
