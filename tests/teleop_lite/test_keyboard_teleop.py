#!/usr/bin/env python3
"""The keyboard teleop on a terminal, on a pipe and without either; it always stops the robot at the end."""

import os
import pty
import signal
import statistics
import subprocess
import termios
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from waiting import wait_until

COMMAND = ["rosrun", "teleop_lite", "turtlebot_teleop_key"]
TOPIC = "/turtlebot_teleop_keyboard/cmd_vel"
EXIT_SECONDS = 15.0


class KeyboardTeleopTest(unittest.TestCase):
    def setUp(self):
        self.velocities, self._received_at = [], []
        self._subscriber = rospy.Subscriber(TOPIC, Twist, self._receive, queue_size=100)

    def tearDown(self):
        self._subscriber.unregister()

    def _receive(self, message):
        self._received_at.append(time.monotonic())
        self.velocities.append((message.linear.x, message.angular.z))

    def test_a_script_on_a_pipe_is_executed_and_ends_at_rest(self):
        run = subprocess.run(COMMAND, input=b"i:2.5, j:2.5\nk:0.2", timeout=60, check=False)
        self.assertEqual(run.returncode, 0)
        self.assertAlmostEqual(max(v for v, _ in self.velocities), 0.2)
        self.assertAlmostEqual(max(omega for _, omega in self.velocities), 1.0)
        periods = [later - earlier for earlier, later in zip(self._received_at, self._received_at[1:])]
        self.assertAlmostEqual(statistics.median(periods), 0.1, delta=0.02)
        self.assertEqual(self.velocities[-1], (0.0, 0.0))

    def test_a_script_may_arrive_in_parts(self):
        run = subprocess.Popen(COMMAND, stdin=subprocess.PIPE)
        run.stdin.write(b"i:0.5\n")
        run.stdin.flush()
        wait_until(
            "driving and a stop",
            lambda: (0.0, 0.0) in self.velocities[-1:] and max(self.velocities)[0] > 0.0,
            EXIT_SECONDS,
        )
        run.stdin.write(b"l:1.5")
        run.stdin.close()
        self.assertEqual(run.wait(EXIT_SECONDS), 0)
        self.assertLess(min(omega for _, omega in self.velocities), -0.25)

    def test_a_script_may_be_given_as_arguments(self):
        run = subprocess.run([*COMMAND, "q", "i:1.0"], timeout=60, check=False, capture_output=True)
        self.assertEqual(run.returncode, 0)
        self.assertIn(b"speed 0.22", run.stdout)
        self.assertGreater(max(self.velocities)[0], 0.05)

    def test_without_terminal_and_script_it_fails_with_the_reason(self):
        for text, reason in (
            (b"", b"neither a terminal nor a script"),
            (b"i:2 hello", b"'hello' is not a key"),
        ):
            run = subprocess.run(COMMAND, input=text, stderr=subprocess.PIPE, timeout=60, check=False)
            self.assertEqual(run.returncode, 2)
            self.assertIn(reason, run.stderr)
            self.assertNotIn(b"Traceback", run.stderr)

    def test_ctrl_c_stops_the_robot_and_restores_the_terminal(self):
        self.assertEqual(self._run_on_terminal(lambda run, keyboard: os.write(keyboard, b"\x03")), 0)

    def test_signals_stop_the_robot_and_restore_the_terminal(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            code = self._run_on_terminal(lambda run, _: run.send_signal(number))  # noqa: B023
            self.assertEqual(code, 128 + number)

    def test_a_node_that_is_killed_by_name_stops_the_robot_first(self):
        self._run_on_terminal(
            lambda *_: subprocess.run(["rosnode", "kill", TOPIC.rsplit("/", 1)[0]], check=True)
        )

    def _run_on_terminal(self, end):
        """Holds "u", ends the node, checks that robot and terminal are at rest; the exit code."""
        keyboard, terminal = pty.openpty()
        before = termios.tcgetattr(terminal)
        self.velocities.clear()
        run = subprocess.Popen(COMMAND, stdin=terminal, stdout=subprocess.DEVNULL, start_new_session=True)

        def is_moving():
            os.write(keyboard, b"u")
            return self.velocities and self.velocities[-1][0] >= 0.1

        wait_until("motion", is_moving, EXIT_SECONDS)
        end(run, keyboard)
        code = run.wait(EXIT_SECONDS)
        self.assertEqual(self.velocities[-1], (0.0, 0.0))
        self.assertEqual(termios.tcgetattr(terminal), before)
        os.close(keyboard)
        os.close(terminal)
        return code


if __name__ == "__main__":
    rospy.init_node("test_keyboard_teleop")
    rostest.rosrun("home_service_tests", "keyboard_teleop", KeyboardTeleopTest)
