#!/usr/bin/env python3
"""A synchronised node has static transforms at its first tick, and is named when it does not answer."""

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

from planar_ros.lockstep import LockstepClient

# Longer than the time limit of an answer [wall s].
HELD_UP = 8.0


class TestSynchronisedNode(unittest.TestCase):
    def test_static_transforms_are_there_at_the_first_tick_however_late_their_node_starts(self):
        frames, ticks = set(), []
        step = LockstepClient.of_node()

        def keep(message):
            frames.update(each.child_frame_id for each in message.transforms)

        rospy.Subscriber("/tf_static", TFMessage, keep, queue_size=10)
        step.on_instant(lambda: ticks.append(frozenset(frames)))
        step.join()
        wait_until("ticks", lambda: len(ticks) > 5, 30.0)
        self.assertIn("late", ticks[0])
        self.assertIn("base_link", ticks[0], "of the robot_state_publisher")
        self.check_that_a_node_that_does_not_answer_is_named(step, ticks)

    def check_that_a_node_that_does_not_answer_is_named(self, step, ticks):
        """Time goes on without it, and with it again as soon as it answers."""
        logged, remarks, is_held_up = [], [], threading.Event()
        rospy.Subscriber("/rosout", Log, lambda line: logged.append((line.name, line.msg)))
        rospy.Subscriber("/simulation/remarks", String, lambda message: remarks.append(message.data))

        def hold_up():
            if not is_held_up.is_set():
                time.sleep(HELD_UP)
                is_held_up.set()

        step.on_instant(hold_up)
        wait_until("an end of it", is_held_up.is_set, 2.0 * HELD_UP)
        warning = "no progress of synchronised_node: the simulation goes on without it in real time"
        wait_until("its name in the log", lambda: ("/sim_bridge", warning) in logged)
        reason = re.compile(r"/synchronised_node did not answer for 5 s at \d+\.\d\d s")
        wait_until("its name in the remarks", lambda: any(map(reason.search, remarks)))
        count = len(ticks)
        wait_until("more ticks", lambda: len(ticks) > count + 5)


if __name__ == "__main__":
    rospy.init_node("synchronised_node")
    rostest.rosrun("home_service_tests", "synchronised_node", TestSynchronisedNode)
