"""Shared by tests of move_base: a client of its action, and a recorder of topics."""

import math
import time
import unittest

import actionlib
import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from geometry_msgs.msg import PoseStamped, Quaternion, Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import Odometry
from recording import is_connected_to_all
from waiting import wait_until

from planar_ros.calls.actions import goal_is_over, server_is_ready

# Time-outs in wall seconds: start of a node; delivery of a message on a busy machine; any condition.
START_SECONDS, DELIVERY_SECONDS, MAX_WAIT_SECONDS = 60.0, 10.0, 120.0
LEVEL = (0.0, 0.0, 0.0, 1.0)
# Positions in the home [m].
IN_ONE_ROOM, IN_THE_NEXT_ROOM = (1.0, 0.0), (2.0, 3.0)


def pose_at(x, y, frame="map", quaternion=LEVEL):
    message = PoseStamped()
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.y = x, y
    message.pose.orientation = Quaternion(*quaternion)
    return message


def points_of(cloud):
    """The fields of a float32 PointCloud2 by name, in order: arrays (N,)."""
    points = np.frombuffer(cloud.data, "<f4").reshape(cloud.width, -1)
    assert points.shape[1] == len(cloud.fields)
    return {field.name: points[:, field.offset // 4] for field in cloud.fields}


class MessageRecorder:
    """Records the messages of a topic with their times of arrival."""

    def __init__(self, topic, kind):
        self.messages, self.times = [], []
        self._subscriber = rospy.Subscriber(topic, kind, self._on_message)

    def _on_message(self, message):
        self.times.append(rospy.get_time())
        self.messages.append(message)

    def connected(self):
        """Return itself once all publishers send to it, so that a message published once is not missed."""
        wait_until("the publishers", lambda: is_connected_to_all(self._subscriber))
        return self

    def close(self):
        self._subscriber.unregister()

    def since(self, time):
        return [message for at, message in zip(self.times, self.messages) if at >= time]

    def wait(self):
        """Wait for a message and return the latest."""
        wait_until("a message", lambda: self.messages)
        return self.messages[-1]


class MoveBaseTestCase(unittest.TestCase):
    """A test that leaves the robot at rest and without a goal."""

    @classmethod
    def setUpClass(cls):
        cls.client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        wait_until("move_base", lambda: server_is_ready(cls.client), START_SECONDS)
        cls.commands = MessageRecorder("cmd_vel", Twist)
        cls.odometry = MessageRecorder("odom", Odometry)
        cls.statuses = MessageRecorder("move_base/status", GoalStatusArray)

    def has_active_goal(self):
        newest = self.statuses.messages[-1].status_list
        return any(status.status in (GoalStatus.PENDING, GoalStatus.ACTIVE) for status in newest)

    def tearDown(self):
        self.come_to_rest()

    def come_to_rest(self):
        """Cancel only an active goal: a later cancellation could overtake the goal of the next test."""
        at = rospy.get_time()
        self.wait_until(lambda: self.statuses.since(at))
        if self.has_active_goal():
            self.client.cancel_all_goals()
        self.wait_until(lambda: not self.has_active_goal())
        self.odometry.wait()
        self.wait_until(lambda: abs(self.odometry.messages[-1].twist.twist.linear.x) < 0.01)

    def wait_until(self, is_so, seconds=30.0):
        """Fail after so many simulated seconds, plus wall time for the delivery of messages."""
        until, start = rospy.get_time() + seconds, time.monotonic()
        while not is_so():
            wall = time.monotonic() - start
            is_late = wall > DELIVERY_SECONDS and rospy.get_time() > until
            self.assertFalse(is_late or wall > MAX_WAIT_SECONDS, "time-out")
            time.sleep(0.01)

    def result_of(self, client=None, seconds=60.0):
        """State and text of the latest goal."""
        client = client or self.client
        self.wait_until(lambda: goal_is_over(client), seconds)
        return client.get_state(), client.get_goal_status_text()

    def end_of(self, pose):
        self.client.send_goal(MoveBaseGoal(pose))
        return self.result_of()

    def robot_xy(self):
        """Position of the robot by odometry [m]."""
        position = self.odometry.wait().pose.pose.position
        return position.x, position.y

    def far_goal(self):
        """A goal in the other room, wherever earlier tests have left the robot."""
        robot_xy = self.robot_xy()
        return pose_at(*max(IN_ONE_ROOM, IN_THE_NEXT_ROOM, key=lambda place: math.dist(place, robot_xy)))

    def drive(self, pose):
        """Send a goal and wait until the robot drives."""
        self.client.send_goal(MoveBaseGoal(pose))
        self.wait_until(
            lambda: self.odometry.messages and self.odometry.messages[-1].twist.twist.linear.x > 0.2
        )
