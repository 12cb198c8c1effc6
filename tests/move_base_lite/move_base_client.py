"""What tests of move_base share: a client of its action, and what is heard on topics."""

import unittest

import actionlib
import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from geometry_msgs.msg import PoseStamped, Quaternion, Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import Odometry
from waiting import wait_until

LEVEL = (0.0, 0.0, 0.0, 1.0)


def pose_at(x, y, frame="map", quaternion=LEVEL):
    message = PoseStamped()
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.y = x, y
    message.pose.orientation = Quaternion(*quaternion)
    return message


def points_of(cloud):
    """The fields of a PointCloud2 of float32, by name, in order: arrays (N,)."""
    points = np.frombuffer(cloud.data, "<f4").reshape(cloud.width, -1)
    assert points.shape[1] == len(cloud.fields)
    return {field.name: points[:, field.offset // 4] for field in cloud.fields}


class Heard:
    """The messages of a topic with the times they came at."""

    def __init__(self, topic, kind):
        self.messages, self.times = [], []
        self._subscriber = rospy.Subscriber(topic, kind, self._on_message)

    def _on_message(self, message):
        self.times.append(rospy.get_time())
        self.messages.append(message)

    def connected(self):
        """Itself, once there is a publisher that sends to it: what is published only once is not missed."""
        wait_until("a publisher", lambda: self._subscriber.get_num_connections() > 0)
        return self

    def close(self):
        self._subscriber.unregister()

    def since(self, time):
        return [message for at, message in zip(self.times, self.messages) if at >= time]

    def wait(self, seconds=10.0):
        until = rospy.get_time() + seconds
        while not self.messages and rospy.get_time() < until:
            rospy.sleep(0.05)
        return self.messages[-1]


class MoveBaseTestCase(unittest.TestCase):
    """A test that leaves the robot at rest and without a goal."""

    @classmethod
    def setUpClass(cls):
        cls.client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        assert cls.client.wait_for_server(rospy.Duration(30.0))
        cls.commands = Heard("cmd_vel", Twist)
        cls.odometry = Heard("odom", Odometry)
        cls.statuses = Heard("move_base/status", GoalStatusArray)

    def has_active_goal(self):
        newest = self.statuses.messages[-1].status_list
        return any(status.status in (GoalStatus.PENDING, GoalStatus.ACTIVE) for status in newest)

    def tearDown(self):
        """Ends what is under way, and nothing else: a cancellation may overtake the next test's goal."""
        at = rospy.get_time()
        self.wait_until(lambda: self.statuses.since(at))
        if self.has_active_goal():
            self.client.cancel_all_goals()
        self.wait_until(lambda: not self.has_active_goal())
        self.odometry.wait()
        self.wait_until(lambda: abs(self.odometry.messages[-1].twist.twist.linear.x) < 0.01)

    def wait_until(self, is_so, seconds=30.0):
        until = rospy.get_time() + seconds
        while not is_so():
            self.assertLess(rospy.get_time(), until, "waited in vain")
            rospy.sleep(0.02)

    def end_of(self, pose, seconds=60.0):
        self.client.send_goal(MoveBaseGoal(pose))
        self.assertTrue(self.client.wait_for_result(rospy.Duration(seconds)), "no result")
        return self.client.get_state(), self.client.get_goal_status_text()

    def drive(self, pose):
        """Sends a goal and returns when the robot is under way."""
        self.client.send_goal(MoveBaseGoal(pose))
        self.wait_until(
            lambda: self.odometry.messages and self.odometry.messages[-1].twist.twist.linear.x > 0.2
        )
