#!/usr/bin/env python3
"""Messages that a node publishes before it ends are received, also by slow subscribers."""

import signal
import subprocess
import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from std_msgs.msg import String
from waiting import wait_until

from planar_ros.calls.actions import KILLED_TEXT, goal_is_over, server_is_ready
from planar_ros.node.topics import PATIENCE_SECONDS, flush_and_close

TIMES = 10


class ShutdownMessagesTest(unittest.TestCase):
    def test_the_last_message_is_always_received(self):
        received, slow = [], []
        rospy.Subscriber("words", String, lambda message: received.append(message.data))
        rospy.Subscriber("words", String, lambda message: (time.sleep(0.2), slow.append(message.data)))
        every = [f"delivered {number}" for number in range(TIMES)]
        for number, text in enumerate(every):
            run_node(f"_number:={number}")
            wait_until(text, lambda: text in received)  # noqa: B023
        wait_until("the slow subscriber", lambda: set(every) <= set(slow))
        # A latched message may arrive twice at a subscriber that has just connected.
        self.assertEqual([text for text in dict.fromkeys(slow) if text != "nearly"], every)

    def test_a_message_published_on_shutdown_is_always_received(self):
        for _ in range(TIMES):
            received = []
            subscriber = rospy.Subscriber("farewell", String, lambda message: received.append(message.data))  # noqa: B023
            with subprocess.Popen(["rosrun", "home_service_tests", "node_with_shutdown_message.py"]) as node:
                wait_until("the node", lambda: "here" in received)  # noqa: B023
                node.send_signal(signal.SIGINT)
            wait_until("its last message", lambda: "gone" in received)  # noqa: B023
            # A latched message may arrive twice at a subscriber that has just connected.
            self.assertEqual(list(dict.fromkeys(received)), ["here", "gone"])
            subscriber.unregister()

    def test_an_active_goal_is_always_aborted_when_its_server_ends(self):
        for number in range(TIMES):
            name = f"errand_{number}"  # a new name: rospy may still have the connection to the one before
            client = actionlib.SimpleActionClient(name, MoveBaseAction)
            command = ["rosrun", "home_service_tests", "node_with_action.py", f"errand:={name}"]
            with subprocess.Popen(command) as node:
                wait_until("the action", lambda: server_is_ready(client))  # noqa: B023
                client.send_goal(MoveBaseGoal())
                wait_until("its start", lambda: client.get_state() == GoalStatus.ACTIVE)  # noqa: B023
                node.send_signal(signal.SIGINT)
            wait_until("its end", lambda: goal_is_over(client))  # noqa: B023
            status = client.get_state(), client.get_goal_status_text()
            self.assertEqual(status, (GoalStatus.ABORTED, KILLED_TEXT))

    def test_a_node_without_subscribers_ends_at_once(self):
        started = time.monotonic()
        run_node("_number:=0", "words:=no_subscriber")
        print(f"ended after {time.monotonic() - started:.1f} s")

    def test_a_killed_subscriber_is_not_waited_for(self):
        publisher = rospy.Publisher("deserted", String, queue_size=1)
        with subprocess.Popen(["rostopic", "echo", "deserted"], stdout=subprocess.DEVNULL) as subscriber:
            wait_until("a subscriber", publisher.get_num_connections)
            subscriber.kill()
        wait_until("its end", lambda: not publisher.get_num_connections())
        started = time.monotonic()
        flush_and_close(publisher)
        self.assertLess(time.monotonic() - started, PATIENCE_SECONDS / 2)


def run_node(*arguments):
    node = ["rosrun", "home_service_tests", "node_with_two_messages.py"]
    subprocess.run([*node, *arguments], check=True, timeout=30)


if __name__ == "__main__":
    rospy.init_node("test_shutdown_messages")
    rostest.rosrun("home_service_tests", "shutdown_messages", ShutdownMessagesTest)
