#!/usr/bin/env python3
"""A thread that dies takes its node along; what comes too late while a node ends is no news."""

import signal
import subprocess
import unittest

import rosnode
import rospy
import rostest
from std_msgs.msg import Empty

END_SECONDS = 30.0


class ThreadsTest(unittest.TestCase):
    def test_the_node_ends_with_the_reason(self):
        for thread in ("worker", "timer"):
            run = subprocess.run(
                ["rosrun", "home_service_tests", "node_of_threads.py", thread],
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                timeout=END_SECONDS,
                check=False,
            )
            self.assertEqual(run.returncode, 70, run.stdout)
            self.assertRegex(
                run.stdout, r"\[/node_of_threads\] error: the thread .* has died of ValueError: no way on"
            )
            self.assertNotIn("/node_of_threads", rosnode.get_node_names())

    def test_an_answer_that_comes_while_the_node_ends_is_dropped_in_silence(self):
        command = ["rosrun", "home_service_tests", "node_of_answers.py"]
        run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        questions = rospy.Publisher("questions", Empty, queue_size=1, latch=True)
        questions.publish(Empty())
        self.assertEqual(run.stdout.readline(), "asked\n")
        run.send_signal(signal.SIGINT)
        output, _ = run.communicate(timeout=END_SECONDS)
        self.assertEqual(output, "")

    def test_a_log_that_cannot_be_written_while_the_node_ends_is_no_reason_for_a_traceback(self):
        command = ["rosrun", "home_service_tests", "node_without_a_log.py"]
        run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(run.stdout.readline(), "up\n")
        run.send_signal(signal.SIGINT)
        output, _ = run.communicate(timeout=END_SECONDS)
        self.assertIn("the node ends", output)
        self.assertNotIn("Traceback", output)
        self.assertNotIn("Logging error", output)
        self.assertEqual(run.returncode, 0)


if __name__ == "__main__":
    rospy.init_node("test_threads")
    rostest.rosrun("home_service_tests", "threads", ThreadsTest)
