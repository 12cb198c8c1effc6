#!/usr/bin/env python3
"""A node in step hears all from its first moment on, and is named when it does not answer."""

import re
import threading
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Log
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from waiting import wait_until

from planar_ros.step import LockstepClient

# Wall seconds, longer than an answer may take.
HELD_UP = 8.0


class TestFirstWords(unittest.TestCase):
    def test_static_transforms_are_there_at_the_first_moment_however_late_their_node_starts(self):
        frames, moments = set(), []
        step = LockstepClient.of_node()

        def keep(message):
            frames.update(each.child_frame_id for each in message.transforms)

        rospy.Subscriber("/tf_static", TFMessage, keep, queue_size=10)
        step.at_moments(lambda: moments.append(frozenset(frames)))
        step.join()
        wait_until("moments", lambda: len(moments) > 5, 30.0)
        self.assertIn("late", moments[0])
        self.assertIn("base_link", moments[0], "of the robot_state_publisher")
        self.check_that_one_who_does_not_answer_is_named(step, moments)

    def check_that_one_who_does_not_answer_is_named(self, step, moments):
        """And that time goes on without it, and with it again as soon as it answers."""
        logged, remarks, is_held_up = [], [], threading.Event()
        rospy.Subscriber("/rosout", Log, lambda line: logged.append((line.name, line.msg)))
        rospy.Subscriber("/simulation/remarks", String, lambda message: remarks.append(message.data))

        def hold_up():
            if not is_held_up.is_set():
                time.sleep(HELD_UP)
                is_held_up.set()

        step.at_moments(hold_up)
        wait_until("an end of it", is_held_up.is_set, 2.0 * HELD_UP)
        words = "no progress of first_words: the simulation goes on without it in real time"
        wait_until("its name in the log", lambda: ("/sim_bridge", words) in logged)
        reason = re.compile(r"/first_words did not answer for 5 s at \d+\.\d\d s")
        wait_until("its name in the remarks", lambda: any(map(reason.search, remarks)))
        count = len(moments)
        wait_until("more moments", lambda: len(moments) > count + 5)


if __name__ == "__main__":
    rospy.init_node("first_words")
    rostest.rosrun("home_service_tests", "first_words", TestFirstWords)
