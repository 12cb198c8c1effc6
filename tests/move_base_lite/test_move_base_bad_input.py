#!/usr/bin/env python3
"""move_base_lite with invalid and missing inputs: it reports why, stops, and still accepts commands."""

import subprocess
import time

import actionlib
import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from fake_robot import FakeRobot
from geometry_msgs.msg import PoseStamped, Twist
from move_base_client import START_SECONDS, MessageRecorder, MoveBaseTestCase, pose_at
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal, RecoveryStatus
from nav_msgs.msg import OccupancyGrid, Path
from nav_msgs.srv import GetPlan
from roslib.packages import find_node
from sensor_msgs.msg import PointCloud2
from waiting import wait_until

from planar import Pose2
from planar_ros.calls.actions import server_is_ready

STALE = "Sensor data is out of date, we're not going to allow commanding of the base for safety"
NO_CONTROL = "Failed to find a valid control. Even after executing recovery behaviors."
STOP = Twist()
NEXT_ROOM, HERE = (5.2, 2.0), Pose2(1.0, 2.0)
LETHAL, PERIOD = 100, 0.1
RECOVERIES = ("conservative_reset", "rotate_recovery", "move_slow", "aggressive_reset")


class TestMoveBaseBadInput(MoveBaseTestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = FakeRobot()
        cls.robot.has_localization = False
        cls.check_that_the_server_waits_for_map_and_transforms()
        super().setUpClass()

    @classmethod
    def check_that_the_server_waits_for_map_and_transforms(cls):
        """As with the official node, the action starts only when the robot's pose in the map is known."""
        client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        rospy.sleep(2.0)
        assert not server_is_ready(client), "neither map nor localization"
        cls.robot.show_map()
        rospy.sleep(2.0)
        assert not server_is_ready(client), "no localization"
        cls.robot.has_localization = True
        wait_until("the server", lambda: server_is_ready(client), START_SECONDS)

    def setUp(self):
        self.robot.has_localization = self.robot.has_odometry = self.robot.has_scan = True
        self.robot.scan_frame, self.robot.cloud_xyz = "laser", None
        self.robot.spoil = lambda ranges: ranges
        self.robot.base_in_odom, self.robot.odom_in_map = HERE, Pose2()
        rospy.sleep(1.0)

    def assert_stands(self, after=0.3):
        """From ``after`` seconds on, all commands are zero for a while."""
        rospy.sleep(after)
        at = rospy.get_time()
        rospy.sleep(0.5)
        self.assertEqual({str(command) for command in self.commands.since(at)}, {str(STOP)})

    def assert_stops_when_cancelled(self):
        at = rospy.get_time()
        self.client.cancel_goal()
        self.assertEqual(self.result_of()[0], GoalStatus.PREEMPTED)
        self.wait_until(lambda: STOP in self.commands.since(at), 2.0)
        received = enumerate(zip(self.commands.times, self.commands.messages))
        stop, when = next(
            (index, when) for index, (when, command) in received if when >= at and command == STOP
        )
        rospy.loginfo("stopped %.3f s after the cancellation", when - at)
        self.assertLessEqual(when - at, 0.1)
        rospy.sleep(0.5)
        self.assertEqual([command for command in self.commands.messages[stop:] if command != STOP], [])

    def test_cancel_while_planning(self):
        self.block_door(True)
        plan = MessageRecorder("move_base/NavfnROS/plan", Path).connected()
        self.client.send_goal(MoveBaseGoal(pose_at(*NEXT_ROOM)))
        self.wait_until(lambda: plan.messages and not plan.messages[-1].poses)
        self.assert_stops_when_cancelled()

    def test_a_goal_with_too_large_coordinates_is_refused(self):
        """Regression: it ended the control thread, and the node never answered a goal again."""
        for far in (1e308, 1e18):
            self.client.send_goal(MoveBaseGoal(pose_at(far, 0.0)))
            state, text = self.result_of()
            self.assertEqual(state, GoalStatus.ABORTED)
            self.assertIn("is out of range", text)

    def test_a_map_without_its_cells_is_ignored(self):
        maps = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        broken = OccupancyGrid(data=[0] * 5)
        broken.info.width = broken.info.height = 4
        broken.info.resolution = 0.05
        maps.publish(broken)
        rospy.sleep(0.5)
        maps.unregister()
        self.drive(pose_at(*NEXT_ROOM))
        self.assert_stops_when_cancelled()

    def test_cancel_while_controlling(self):
        self.drive(pose_at(*NEXT_ROOM))
        self.assert_stops_when_cancelled()

    def test_cancel_in_each_recovery(self):
        # The wall is in the map as well, where no recovery clears it.
        self.addCleanup(self.robot.show_map)
        self.block_door(True)
        self.robot.show_map()
        started = MessageRecorder("move_base/recovery_status", RecoveryStatus).connected()
        for number, name in enumerate(RECOVERIES):
            started.messages.clear()
            self.client.send_goal(MoveBaseGoal(pose_at(*NEXT_ROOM)))
            self.wait_until(
                lambda name=name: name in [message.recovery_behavior_name for message in started.messages],
                60.0,
            )
            status = started.messages[-1]
            self.assertEqual(
                (status.current_recovery_number, status.total_number_of_recoveries), (number, len(RECOVERIES))
            )
            self.assert_stops_when_cancelled()

    def block_door(self, is_blocked):
        """Put a wall into the door, which the laser observes, and remove it after the test."""
        cells = self.robot.grid.cells
        cells[24:56, 62:66] = 100 if is_blocked else 0
        if is_blocked:
            self.addCleanup(self.block_door, False)
        else:
            cells[24:32, 62:66] = cells[48:56, 62:66] = 100

    def test_stamps_far_in_the_past_or_future_do_not_matter(self):
        goals = MessageRecorder("move_base/current_goal", PoseStamped).connected()
        for stamp in (0.5, rospy.get_time() + 1e4):
            for frame, x in (("map", 1.4), ("base_footprint", 0.4)):
                goals.messages.clear()
                pose = pose_at(x, 2.0 if frame == "map" else 0.0, frame)
                pose.header.stamp = rospy.Time.from_sec(stamp)
                at = self.robot.base_in_map
                self.assertEqual(self.end_of(pose), (GoalStatus.SUCCEEDED, "Goal reached."))
                wanted = 1.4 if frame == "map" else at.x + 0.4
                self.assertAlmostEqual(goals.wait().pose.position.x, wanted, delta=0.05)

    def test_when_scans_stop_the_robot_stops_and_the_goal_is_aborted(self):
        self.drive(pose_at(*NEXT_ROOM))
        self.robot.has_scan = False
        # expected_update_rate is 1 s.
        self.assert_stands(after=1.3)
        self.assertTrue(self.has_active_goal())
        state, text = self.result_of()
        self.assertEqual(state, GoalStatus.ABORTED)
        self.assertRegex(text, rf"^{STALE} \[code=SENSOR_STALE: nothing on scan for 4\.\d s\]$")

    def test_when_scans_resume_the_robot_continues(self):
        self.drive(pose_at(*NEXT_ROOM))
        self.robot.has_scan = False
        self.assert_stands(after=1.3)
        self.robot.has_scan = True
        self.assertEqual(self.result_of(), (GoalStatus.SUCCEEDED, "Goal reached."))

    def test_a_laser_that_publishes_implausible_scans_stops_the_robot_and_is_reported(self):
        frozen = []

        def freeze(ranges):
            frozen.append(ranges)
            return frozen[0]

        for spoil, why in (
            (lambda ranges: np.full_like(ranges, np.nan), "nearly all of its beams are NaN"),
            (freeze, "it stays the same to the last bit while the robot moves"),
        ):
            self.setUp()
            diagnostics = MessageRecorder("/diagnostics", DiagnosticArray).connected()
            self.drive(pose_at(*NEXT_ROOM))
            self.robot.spoil = spoil
            self.assert_stands(after=2.0)
            status = diagnostics.messages[-1].status[0]
            self.assertEqual(
                (status.level, status.message, status.hardware_id),
                (DiagnosticStatus.ERROR, f"scan: {why}", "scan"),
            )
            self.assertTrue(self.has_active_goal())
            state, text = self.result_of()
            self.assertEqual(state, GoalStatus.ABORTED)
            self.assertIn(f"[code=TF_ERROR: waiting for a trustworthy sensor (scan: {why})]", text)
            diagnostics.close()

    def test_scans_from_an_unknown_frame_are_ignored(self):
        self.drive(pose_at(*NEXT_ROOM))
        self.robot.scan_frame = "nowhere"
        self.assert_stands(after=1.3)
        self.assertRegex(self.result_of()[1], r"\[code=SENSOR_STALE: nothing on scan for 4\.\d s\]$")

    def test_when_transforms_stop_the_robot_stops_and_the_goal_is_aborted(self):
        """Localization needs odometry and scans: if those are missing, the message names them."""
        silence = r"; nothing on /scan for \d\.\d s"
        for switched_off, frames, why in (
            (("has_odometry",), "odom -> base_footprint", ""),
            (("has_localization",), "map -> odom", ""),
            (("has_localization", "has_odometry"), "odom -> base_footprint", ""),
            (("has_localization", "has_scan"), "map -> odom", silence),
        ):
            self.setUp()
            self.drive(pose_at(*NEXT_ROOM))
            for what in switched_off:
                setattr(self.robot, what, False)
            self.assert_stands(after=0.8)
            self.robot.spoil = (
                lambda ranges: 0.7 * ranges
            )  # the scene changes, as when a person passes: odometry stays trusted
            state, text = self.result_of()
            self.assertEqual(state, GoalStatus.ABORTED)
            old = rf"waiting for a transform {frames} that is not 4\.\d s old{why}"
            self.assertRegex(text, rf"^{NO_CONTROL} \[code=TF_ERROR: {old}\]$")

    def test_a_goal_is_cancelled_while_transforms_are_missing(self):
        self.drive(pose_at(*NEXT_ROOM))
        self.robot.has_odometry = False
        rospy.sleep(1.0)
        self.assert_stops_when_cancelled()

    def test_a_jump_of_localization_changes_the_path_not_the_goal(self):
        self.drive(pose_at(*NEXT_ROOM))
        self.robot.odom_in_map = Pose2(-0.4, 0.3, 0.1)
        self.assertEqual(self.result_of(), (GoalStatus.SUCCEEDED, "Goal reached."))
        self.assertLess(self.robot.base_in_map.distance_to(Pose2(*NEXT_ROOM)), 0.15)

    def test_a_cloud_marks_obstacles_at_the_robots_height_and_clears_along_its_rays(self):
        costmap = MessageRecorder("move_base/local_costmap/costmap", OccupancyGrid)
        ahead = HERE.x + 0.8, HERE.y

        def marked():
            message = costmap.messages[-1]
            info = message.info
            row = int((ahead[1] - info.origin.position.y) / info.resolution)
            column = int((ahead[0] - info.origin.position.x) / info.resolution)
            cells = np.array(message.data).reshape(info.height, info.width)
            return (cells[row - 3 : row + 4, column - 1 : column + 2] == LETHAL).any()

        costmap.wait()
        self.assertFalse(marked())
        self.robot.cloud_xyz = [(0.8, 0.05 * i - 0.5, 0.3) for i in range(21)]
        self.wait_until(marked, 5.0)
        # Too far to mark, near enough to clear along the rays.
        self.robot.cloud_xyz = [(2.8, 0.02 * i - 0.9, 0.3) for i in range(91)]
        self.wait_until(lambda: not marked(), 5.0)
        self.robot.cloud_xyz = [(0.8, 0.05 * i - 0.5, 2.5) for i in range(21)]
        rospy.sleep(1.0)
        self.assertFalse(marked(), "above max_obstacle_height")

    def test_an_invalid_cloud_is_ignored(self):
        publisher = rospy.Publisher("cloud", PointCloud2, queue_size=1)
        self.wait_until(publisher.get_num_connections)
        publisher.publish(PointCloud2(width=3, height=1, point_step=12, row_step=36))
        self.assertEqual(self.end_of(pose_at(1.3, 2.0)), (GoalStatus.SUCCEEDED, "Goal reached."))

    def test_plans_are_made_and_refused_as_by_the_official_node(self):
        make_plan = rospy.ServiceProxy("move_base/make_plan", GetPlan)
        plan = make_plan(pose_at(1.0, 1.0), pose_at(*NEXT_ROOM), 0.0).plan.poses
        self.assertEqual((plan[0].pose.position.x, plan[-1].pose.position.x), (1.0, NEXT_ROOM[0]))
        in_the_wall = pose_at(3.2, 1.0)
        self.assertEqual(make_plan(PoseStamped(), in_the_wall, 0.0).plan.poses, [])
        near = make_plan(PoseStamped(), in_the_wall, 1.0).plan.poses
        self.assertEqual(near[-1].pose.position.x, 3.2, "make_plan_add_unreachable_goal")
        self.assertEqual(make_plan(PoseStamped(), pose_at(1.0, 1.0, "nowhere"), 0.0).plan.poses, [])
        of_planner = rospy.ServiceProxy("move_base/NavfnROS/make_plan", GetPlan)
        self.drive(pose_at(*NEXT_ROOM))
        self.assertGreater(len(of_planner(PoseStamped(), pose_at(1.0, 1.0), 0.0).plan.poses), 5)
        with self.assertRaisesRegex(rospy.ServiceException, "must be in an inactive state to make a plan"):
            make_plan(PoseStamped(), pose_at(1.0, 1.0), 0.0)

    def test_status_is_published_five_times_a_second_and_lists_goals_for_five_seconds(self):
        statuses = MessageRecorder("move_base/status", GoalStatusArray)
        self.assertEqual(self.end_of(pose_at(1.3, 2.0))[0], GoalStatus.SUCCEEDED)
        rospy.sleep(3.0)
        self.assertTrue(statuses.messages[-1].status_list)
        last = statuses.messages[-1].status_list[-1]
        self.assertEqual((last.status, last.text), (GoalStatus.SUCCEEDED, "Goal reached."))
        rospy.sleep(4.0)
        self.assertEqual(statuses.messages[-1].status_list, [])

    def test_contradicting_parameters_end_the_node_with_their_name(self):
        rospy.set_param(
            "/broken/global_costmap",
            {
                "plugins": [{"name": "obstacle_layer", "type": "costmap_2d::ObstacleLayer"}],
                "obstacle_layer": {
                    "observation_sources": "scan",
                    "scan": {
                        "data_type": "LaserScan",
                        "marking": True,
                        "clearing": True,
                        "raytrace_range": 2.0,
                    },
                },
            },
        )
        command = [*find_node("move_base_lite", "move_base_lite"), "__name:=broken"]
        ended = subprocess.run(command, stderr=subprocess.PIPE, timeout=60.0, text=True, check=False)
        self.assertEqual(ended.returncode, 2)
        self.assertIn(
            "error: /broken/global_costmap/obstacle_layer/scan/raytrace_range must be at least "
            "obstacle_range (2.5), else marks are never cleared, got 2.0",
            ended.stderr,
        )
        self.assertNotIn("Traceback", ended.stderr)

    def test_z_a_jump_back_of_time_aborts_the_goal_and_the_node_keeps_running(self):
        self.drive(pose_at(*NEXT_ROOM))
        self.robot.now -= 20.0
        until = time.monotonic() + 10.0
        while self.client.get_state() == GoalStatus.ACTIVE and time.monotonic() < until:
            time.sleep(0.1)
        self.assertEqual(self.client.get_state(), GoalStatus.ABORTED)
        text = self.client.get_goal_status_text()
        self.assertEqual(text, "Aborting on the goal because time has jumped back")
        self.assertEqual(self.end_of(pose_at(1.3, 2.0)), (GoalStatus.SUCCEEDED, "Goal reached."))


if __name__ == "__main__":
    rospy.init_node("move_base_bad_input")
    rostest.rosrun("home_service_tests", "move_base_bad_input", TestMoveBaseBadInput)
