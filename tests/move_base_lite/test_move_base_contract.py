#!/usr/bin/env python3
"""move_base_lite has the action, topics, services and texts of move_base 1.17."""

import math
import time

import actionlib
import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PolygonStamped, PoseStamped, Twist
from map_msgs.msg import OccupancyGridUpdate
from move_base_client import IN_ONE_ROOM, MessageRecorder, MoveBaseTestCase, points_of, pose_at
from move_base_msgs.msg import (
    MoveBaseAction,
    MoveBaseActionFeedback,
    MoveBaseActionGoal,
    MoveBaseGoal,
    RecoveryStatus,
)
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from nav_msgs.srv import GetPlan
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Empty

from planar_ros.calls.actions import server_is_ready

PERIOD, TRIES, RESOLUTION = 0.1, 5, 0.05
NO_PLAN = "Failed to find a valid plan. Even after executing recovery behaviors."
NEAR, IN_A_WALL, OFF_THE_MAP = IN_ONE_ROOM, (5.0, 4.0), (50.0, 3.0)
INSIDE_THE_TABLE = (0.07, 3.08)


class TestMoveBaseContract(MoveBaseTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.make_plan = rospy.ServiceProxy("move_base/make_plan", GetPlan)
        cls.make_plan.wait_for_service(30.0)

    def test_a_reached_goal_has_the_official_text(self):
        current_goal, plan = (
            MessageRecorder("move_base/current_goal", PoseStamped).connected(),
            MessageRecorder("move_base/NavfnROS/plan", Path).connected(),
        )
        local_plan = MessageRecorder("move_base/DWAPlannerROS/local_plan", Path).connected()
        global_plan = MessageRecorder("move_base/DWAPlannerROS/global_plan", Path).connected()
        self.assertEqual(self.end_of(pose_at(0.8, 0.3)), (GoalStatus.SUCCEEDED, "Goal reached."))
        self.wait_until(lambda: self.commands.messages[-1] == Twist(), seconds=1.0)
        self.assertEqual(current_goal.wait().pose.position.x, 0.8)
        self.assertEqual(plan.wait().header.frame_id, "map")
        self.assertEqual(local_plan.wait().header.frame_id, "odom")
        self.assertEqual(global_plan.wait().header.frame_id, "odom")

    def test_a_goal_in_another_frame_or_with_a_leading_slash_is_understood(self):
        self.assertEqual(self.end_of(pose_at(0.3, 0.0, "/map"))[0], GoalStatus.SUCCEEDED)
        self.assertEqual(self.end_of(pose_at(0.3, 0.0, "base_footprint"))[0], GoalStatus.SUCCEEDED)

    def test_invalid_goals_are_aborted_with_a_reason(self):
        invalid = "Aborting on goal because it was sent with an invalid quaternion"
        for pose, text in [
            (pose_at(*NEAR, quaternion=(0.0, 0.0, 0.0, 0.0)), invalid),
            (pose_at(*NEAR, quaternion=(0.3, 0.0, 0.0, 1.0)), invalid),
            (pose_at(*NEAR, quaternion=(0.0, 0.0, math.nan, 1.0)), invalid),
            (pose_at(*OFF_THE_MAP), f"{NO_PLAN} [code=OUT_OF_MAP: "),
            (pose_at(*IN_A_WALL), f"{NO_PLAN} [code=GOAL_BLOCKED: "),
            (pose_at(*NEAR, frame="nowhere"), f"{NO_PLAN} [code=TF_ERROR: "),
        ]:
            state, result_text = self.end_of(pose)
            self.assertEqual(state, GoalStatus.ABORTED)
            self.assertTrue(result_text.startswith(text), result_text)

    def test_the_outcome_has_the_code_of_move_base_flex(self):
        feedback = MessageRecorder("move_base/nav_feedback", DiagnosticStatus).connected()
        outcomes = MessageRecorder("move_base/outcome", DiagnosticStatus).connected()
        for pose, code, reason in [
            (pose_at(*NEAR), "0", "SUCCESS"),
            (pose_at(*IN_A_WALL), "15", "GOAL_BLOCKED"),
            (pose_at(*NEAR, frame="nowhere"), "16", "TF_ERROR"),
        ]:
            _, text = self.end_of(pose)
            self.wait_until(lambda text=text: outcomes.messages and outcomes.messages[-1].message == text)
            values = {pair.key: pair.value for pair in outcomes.messages[-1].values}
            self.assertEqual((values["outcome"], values["reason"]), (code, reason))
        known = {pair.key for pair in feedback.wait().values}
        self.assertLessEqual({"distance_remaining", "estimated_time_remaining"}, known)

    def test_cancelling_stops_the_robot_within_a_period(self):
        # One period to decide, and lock-step lets the clock run one period ahead of the node. It does not
        # wait for this test, whose own delays count too.
        is_soon = (self.seconds_to_stop() <= 2 * PERIOD + 0.02 for _ in range(TRIES))
        self.assertTrue(any(is_soon))

    def seconds_to_stop(self):
        """Simulated time from a cancellation to the first zero command."""
        self.come_to_rest()
        self.drive(self.far_goal())
        at = rospy.get_time()
        self.client.cancel_goal()
        self.assertEqual(self.result_of()[0], GoalStatus.PREEMPTED)
        self.wait_until(lambda: Twist() in self.commands.since(at))
        times = zip(self.commands.times, self.commands.messages)
        return min(time for time, message in times if time >= at and message == Twist()) - at

    def test_a_goal_that_is_cancelled_before_it_is_accepted_is_not_executed(self):
        pause, unpause = (
            rospy.ServiceProxy(f"/gazebo/{name}_physics", Empty) for name in ("pause", "unpause")
        )
        pause()
        self.addCleanup(unpause)
        self.client.send_goal(MoveBaseGoal(self.far_goal()))
        time.sleep(1.0)  # messages that arrive while time stands are processed after half a second
        self.client.cancel_goal()
        time.sleep(1.0)
        unpause()
        # If both are processed at once, the cancellation comes first.
        self.assertIn(self.result_of()[0], (GoalStatus.PREEMPTED, GoalStatus.RECALLED))

    def test_a_new_goal_preempts_the_old_one_without_stopping(self):
        other = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        self.wait_until(lambda: server_is_ready(other))
        goal = self.far_goal()
        self.drive(goal)
        at = rospy.get_time()
        other.send_goal(MoveBaseGoal(pose_at(goal.pose.position.x - 0.2, goal.pose.position.y)))
        self.assertEqual(self.result_of()[0], GoalStatus.PREEMPTED)
        rospy.sleep(0.3)
        self.assertNotIn(Twist(), self.commands.since(at))

    def test_the_simple_topic_sends_a_goal(self):
        publisher = rospy.Publisher("move_base_simple/goal", PoseStamped, queue_size=1)
        current_goal = MessageRecorder("move_base/current_goal", PoseStamped).connected()
        relayed, feedback = (
            MessageRecorder("move_base/goal", MoveBaseActionGoal).connected(),
            MessageRecorder("move_base/feedback", MoveBaseActionFeedback).connected(),
        )
        truth = MessageRecorder("base_pose_ground_truth", Odometry).connected()
        self.wait_until(publisher.get_num_connections)
        publisher.publish(pose_at(*NEAR))
        self.assertEqual(current_goal.wait().pose.position.x, NEAR[0])
        self.assertEqual(relayed.wait().goal.target_pose.pose.position.x, NEAR[0])
        position = feedback.wait().feedback.base_position
        self.assertEqual(position.header.frame_id, "map")
        self.wait_until(lambda: truth.messages and truth.messages[-1].header.stamp >= position.header.stamp)
        then = next(each for each in truth.messages if each.header.stamp >= position.header.stamp)
        true, estimate = then.pose.pose.position, position.pose.position
        self.assertLess(math.hypot(estimate.x - true.x, estimate.y - true.y), 0.3, "localization")

    def test_make_plan_plans_while_idle_and_is_refused_while_active(self):
        potential = MessageRecorder("move_base/NavfnROS/potential", PointCloud2).connected()
        goal, robot_xy = self.far_goal(), self.robot_xy()
        goal_xy = (goal.pose.position.x, goal.pose.position.y)
        plan = self.make_plan(PoseStamped(), goal, 0.0).plan
        path = [(each.pose.position.x, each.pose.position.y) for each in plan.poses]
        self.assertLess(math.dist(path[0], robot_xy), 0.2)
        self.assertEqual(path[-1], goal_xy)
        self.assertGreater(len(path), math.dist(robot_xy, goal_xy) / RESOLUTION / math.sqrt(2.0))
        self.assertEqual(plan.header.frame_id, "")
        self.assertEqual(plan.poses[0].header.frame_id, "map")
        self.assertEqual(potential.wait().header.frame_id, "map")
        wave = points_of(potential.wait())
        self.assertEqual(list(wave), ["x", "y", "z", "pot"])
        at_goal = np.hypot(wave["x"] - goal_xy[0], wave["y"] - goal_xy[1]).argmin()
        self.assertAlmostEqual(wave["z"][at_goal], 20.0, delta=0.5)
        self.assertEqual(self.make_plan(PoseStamped(), pose_at(*OFF_THE_MAP), 0.0).plan.poses, [])
        self.drive(self.far_goal())
        with self.assertRaisesRegex(rospy.ServiceException, "must be in an inactive state"):
            self.make_plan(PoseStamped(), pose_at(*NEAR), 0.0)

    def test_each_new_subscriber_gets_the_full_costmap_then_updates(self):
        grid = MessageRecorder("map", OccupancyGrid).wait().info
        for _ in range(2):
            full = MessageRecorder("move_base/global_costmap/costmap", OccupancyGrid)
            self.assertEqual(full.wait().info.width, grid.width)
            self.assertEqual(full.wait().info.height, grid.height)
            self.assertEqual(full.wait().header.frame_id, "map")
            full.close()
        full = MessageRecorder("move_base/global_costmap/costmap", OccupancyGrid)
        updates = MessageRecorder("move_base/global_costmap/costmap_updates", OccupancyGridUpdate)
        block = updates.wait()
        self.assertEqual(len(block.data), block.width * block.height)
        self.assertLessEqual(block.x + block.width, grid.width)
        cells = grid.width * grid.height
        self.assertLess(len(block.data), cells, "what the laser cannot see has not changed")
        local = MessageRecorder("move_base/local_costmap/costmap", OccupancyGrid)
        self.assertEqual((local.wait().info.width, local.wait().header.frame_id), (80, "odom"))
        footprint = MessageRecorder("move_base/local_costmap/footprint", PolygonStamped)
        self.assertEqual(len(footprint.wait().polygon.points), 16)

    def test_a_goal_without_a_path_runs_the_recovery_behaviours_before_it_is_aborted(self):
        recoveries = MessageRecorder("move_base/recovery_status", RecoveryStatus).connected()
        state, text = self.end_of(pose_at(*INSIDE_THE_TABLE))
        self.assertEqual(state, GoalStatus.ABORTED)
        self.assertTrue(text.startswith(f"{NO_PLAN} [code=NO_PATH: "), text)
        self.wait_until(lambda: len(recoveries.messages) >= 4)
        self.assertEqual(
            [
                (status.recovery_behavior_name, status.current_recovery_number)
                for status in recoveries.messages
            ],
            [
                ("conservative_reset", 0),
                ("rotate_recovery", 1),
                ("aggressive_reset", 2),
                ("rotate_recovery_again", 3),
            ],
        )
        self.assertEqual(recoveries.messages[0].total_number_of_recoveries, 4)


if __name__ == "__main__":
    rospy.init_node("move_base_contract")
    rostest.rosrun("home_service_tests", "move_base_contract", TestMoveBaseContract)
