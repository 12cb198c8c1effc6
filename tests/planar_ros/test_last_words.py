#!/usr/bin/env python3
"""What a node says at its end is heard, also by those who are slow to listen."""

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
from planar_ros.node.flush import PATIENCE_SECONDS, flush_and_close

TIMES = 10


class LastWordsTest(unittest.TestCase):
    def test_they_are_heard_every_time(self):
        heard, slow = [], []
        rospy.Subscriber("words", String, lambda message: heard.append(message.data))
        rospy.Subscriber("words", String, lambda message: (time.sleep(0.2), slow.append(message.data)))
        every = [f"delivered {number}" for number in range(TIMES)]
        for number, word in enumerate(every):
            speak(f"_number:={number}")
            wait_until(word, lambda: word in heard)  # noqa: B023
        wait_until("the slow listener", lambda: set(every) <= set(slow))
        # What is latched may come once more to one who connects just then.
        self.assertEqual([word for word in dict.fromkeys(slow) if word != "nearly"], every)

    def test_what_is_to_be_said_at_the_end_is_heard_every_time(self):
        for _ in range(TIMES):
            heard = []
            listener = rospy.Subscriber("farewell", String, lambda message: heard.append(message.data))  # noqa: B023
            with subprocess.Popen(["rosrun", "home_service_tests", "node_of_last_words.py"]) as node:
                wait_until("the node", lambda: "here" in heard)  # noqa: B023
                node.send_signal(signal.SIGINT)
            wait_until("its last word", lambda: "gone" in heard)  # noqa: B023
            # What is latched may come once more to one who connects just then.
            self.assertEqual(list(dict.fromkeys(heard)), ["here", "gone"])
            listener.unregister()

    def test_who_has_sent_a_goal_hears_every_time_that_its_node_ends(self):
        for number in range(TIMES):
            name = f"errand_{number}"  # its own: rospy may not have noticed yet that the one before has ended
            client = actionlib.SimpleActionClient(name, MoveBaseAction)
            command = ["rosrun", "home_service_tests", "node_of_an_action.py", f"errand:={name}"]
            with subprocess.Popen(command) as node:
                wait_until("the action", lambda: server_is_ready(client))  # noqa: B023
                client.send_goal(MoveBaseGoal())
                wait_until("its start", lambda: client.get_state() == GoalStatus.ACTIVE)  # noqa: B023
                node.send_signal(signal.SIGINT)
            wait_until("its end", lambda: goal_is_over(client))  # noqa: B023
            told = client.get_state(), client.get_goal_status_text()
            self.assertEqual(told, (GoalStatus.ABORTED, KILLED_TEXT))

    def test_nobody_is_waited_for_in_vain(self):
        started = time.monotonic()
        speak("_number:=0", "words:=unheard")
        print(f"ended after {time.monotonic() - started:.1f} s")

    def test_who_was_killed_is_not_waited_for(self):
        publisher = rospy.Publisher("deserted", String, queue_size=1)
        with subprocess.Popen(["rostopic", "echo", "deserted"], stdout=subprocess.DEVNULL) as listener:
            wait_until("a listener", publisher.get_num_connections)
            listener.kill()
        wait_until("its end", lambda: not publisher.get_num_connections())
        started = time.monotonic()
        flush_and_close(publisher)
        self.assertLess(time.monotonic() - started, PATIENCE_SECONDS / 2)


def speak(*arguments):
    node = ["rosrun", "home_service_tests", "node_of_few_words.py"]
    subprocess.run([*node, *arguments], check=True, timeout=30)


if __name__ == "__main__":
    rospy.init_node("test_last_words")
    rostest.rosrun("home_service_tests", "last_words", LastWordsTest)
