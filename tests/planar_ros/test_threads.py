#!/usr/bin/env python3
"""A thread that dies takes its node along."""

import subprocess
import unittest

import rosnode
import rospy
import rostest

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


if __name__ == "__main__":
    rospy.init_node("test_threads")
    rostest.rosrun("home_service_tests", "threads", ThreadsTest)
