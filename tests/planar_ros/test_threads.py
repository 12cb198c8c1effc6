#!/usr/bin/env python3
"""A failing thread ends its node; messages and logs during shutdown cause no errors."""

import signal
import subprocess
import unittest

import rosnode
import rospy
import rostest
from std_msgs.msg import Empty

END_SECONDS = 30.0


class ThreadsTest(unittest.TestCase):
    def test_a_failing_thread_ends_its_node_with_an_error(self):
        for thread in ("worker", "timer"):
            run = subprocess.run(
                ["rosrun", "home_service_tests", "node_with_failing_thread.py", thread],
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                timeout=END_SECONDS,
                check=False,
            )
            self.assertEqual(run.returncode, 70, run.stdout)
            self.assertRegex(
                run.stdout,
                r"\[/node_with_failing_thread\] error: thread .* died of ValueError: no way on",
            )
            self.assertNotIn("/node_with_failing_thread", rosnode.get_node_names())

    def test_a_message_published_during_shutdown_is_dropped_silently(self):
        command = ["rosrun", "home_service_tests", "node_with_late_answer.py"]
        run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        questions = rospy.Publisher("questions", Empty, queue_size=1, latch=True)
        questions.publish(Empty())
        self.assertEqual(run.stdout.readline(), "asked\n")
        run.send_signal(signal.SIGINT)
        output, _ = run.communicate(timeout=END_SECONDS)
        self.assertEqual(output, "")

    def test_an_unwritable_log_causes_no_traceback_on_shutdown(self):
        command = ["rosrun", "home_service_tests", "node_without_log.py"]
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
