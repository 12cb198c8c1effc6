#!/usr/bin/env python3
"""The action explore with a mock move_base that succeeds, never ends or aborts."""

import time
import unittest

import actionlib
import rosnode
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from home_service_msgs.msg import ExploreAction, ExploreActionFeedback, ExploreGoal
from move_base_msgs.msg import MoveBaseAction
from recording import is_connected_to_all
from waiting import wait_until

from planar import Pose2, grid_from_picture
from planar_ros.calls.actions import KILLED_TEXT, goal_is_over, server_is_ready
from planar_ros.messages.conversion import OccupancyGridArrays, grid_to_msg, pose2_from_msg
from planar_ros.messages.transforms import Transforms

HALF_KNOWN = grid_from_picture("######??\n#....???\n#....???\n#....???\n######??", resolution=0.5)
KNOWN = grid_from_picture("########\n#......#\n#......#\n#......#\n########", resolution=0.5)
START = Pose2(1.25, 1.25)


class ToyWorld:
    """Publishes map and pose, and serves move_base."""

    def __init__(self):
        self.robot = START
        self.behavior = "succeeds"
        self.cancelled = 0
        self._transforms = Transforms()
        self._map = rospy.Publisher("map", OccupancyGridArrays, queue_size=1, latch=True)
        self._server = actionlib.SimpleActionServer("move_base", MoveBaseAction, self._execute, False)
        self._server.start()
        pose_timer = rospy.Timer(rospy.Duration(0.05), self._publish_pose)
        rospy.on_shutdown(pose_timer.shutdown)

    @property
    def is_driving(self):
        return self._server.is_active()

    def reset(self, behavior):
        self.robot, self.behavior, self.cancelled = START, behavior, 0
        self.show(HALF_KNOWN)

    def show(self, grid):
        self._map.publish(grid_to_msg(grid, rospy.Time.now(), "map"))

    def _publish_pose(self, _event):
        self._transforms.send(self.robot, "map", "base_footprint", rospy.Time.now())

    def _execute(self, goal):
        if self.behavior == "aborts":
            self._server.set_aborted(text="Failed to find a valid plan.")
            return
        while self.behavior == "never ends":
            if self._server.is_preempt_requested():
                self.cancelled += 1
                self._server.set_preempted()
                return
            time.sleep(0.02)
        self.robot = pose2_from_msg(goal.target_pose.pose)
        self.show(KNOWN)
        self._server.set_succeeded(text="Goal reached.")


class ExploreTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = ToyWorld()
        cls.client = actionlib.SimpleActionClient("explore", ExploreAction)
        cls.lonely = actionlib.SimpleActionClient("lonely/explore", ExploreAction)
        # A client's own feedback is lost if the result overtakes it.
        cls.feedback = []
        subscriber = rospy.Subscriber("explore/feedback", ExploreActionFeedback, cls.feedback.append)
        wait_until("a publisher of feedback", lambda: is_connected_to_all(subscriber))

    def test_z_an_open_map_is_explored_and_the_robot_comes_back(self):
        """The last one, as it leaves a map behind in which there is nothing to explore."""
        self.feedback.clear()
        self._explore(self.client, "succeeds")
        self.assertEqual(self._end(self.client), GoalStatus.SUCCEEDED)
        result = self.client.get_result()
        self.assertAlmostEqual(result.explored_area, 6 * 3 * 0.25)
        self.assertGreater(result.duration.to_sec(), 0.0)
        self.assertEqual(result.unreachable, [])
        self.assertLess(self.world.robot.distance_to(START), 0.01)
        wait_until("feedback", lambda: self.feedback)
        first = self.feedback[0].feedback
        self.assertEqual((first.state, first.goal.header.frame_id), ("exploring", "map"))

    def test_cancelling_stops_the_robot_and_ends_the_goal(self):
        self.feedback.clear()
        self._explore(self.client, "never ends")
        wait_until("feedback", lambda: self.feedback)
        self.client.cancel_goal()
        self.assertEqual(self._end(self.client), GoalStatus.PREEMPTED)
        wait_until("the cancel", lambda: self.world.cancelled == 1)
        self.assertGreater(self.client.get_result().explored_area, 0.0)

    def test_what_cannot_be_reached_is_reported(self):
        self._explore(self.client, "aborts")
        self.assertEqual(self._end(self.client), GoalStatus.ABORTED)
        self.assertIn("Failed to find a valid plan.", self.client.get_goal_status_text())
        self.assertEqual(len(self.client.get_result().unreachable), 1)

    def test_without_map_and_move_base_it_gives_up_and_names_them(self):
        self._explore(self.lonely, "succeeds")
        self.assertEqual(self._end(self.lonely), GoalStatus.ABORTED)
        self.assertEqual(
            self.lonely.get_goal_status_text(),
            "a map on /lonely/map and the action /lonely/move_base missing for 1 s",
        )

    def test_zz_the_robot_stops_and_the_goal_ends_when_the_node_does(self):
        """After all others, as there is no explorer any more."""
        self.feedback.clear()
        self._explore(self.client, "never ends")
        wait_until("feedback", lambda: self.feedback)
        wait_until("a goal", lambda: self.world.is_driving)
        rosnode.kill_nodes(["/explore"])
        self.assertEqual(self._end(self.client), GoalStatus.ABORTED)
        self.assertEqual(self.client.get_goal_status_text(), KILLED_TEXT)
        wait_until("the cancel", lambda: self.world.cancelled == 1)

    def _explore(self, client, behavior):
        self.world.reset(behavior)
        wait_until("the action", lambda: server_is_ready(client))
        client.send_goal(ExploreGoal(return_to_start=True))

    def _end(self, client):
        wait_until("the result", lambda: goal_is_over(client))
        return client.get_state()


if __name__ == "__main__":
    rospy.init_node("test_explore")
    rostest.rosrun("home_service_tests", "explore_action", ExploreTest)
