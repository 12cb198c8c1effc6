#!/usr/bin/env python3
"""amcl_lite has the topics, services, frames, stamps and behaviour of amcl 1.17."""

import math
import unittest

import numpy as np
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from dynamic_reconfigure.client import Client
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped
from rosgraph_msgs.msg import Log
from simple_robot import BEAMS, SimpleRobot
from std_msgs.msg import Float32, String
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage
from waiting import PATIENCE_SECONDS, wait_until

from planar import Pose2, wrap
from planar_ros.messages.conversion import SetMapArrays, frame_name, pose2_from_msg, pose2_to_msg

START = Pose2(1.2, 1.5, 0.0)
STEP = Pose2(0.2, 0.0, 0.0)
TURN = Pose2(0.0, 0.0, 0.4)
# Tolerances of a tracked pose [m, rad].
NEAR, NEAR_ANGLE = 0.15, 0.1
# The node's transform_tolerance.
POST_DATED = rospy.Duration(0.3)


class Received:
    """The messages received on a topic."""

    def __init__(self, topic, kind):
        self.messages = []
        self._subscriber = rospy.Subscriber(topic, kind, self.messages.append)

    def wait(self, matches):
        """Return the first message that ``matches``; fail after a time-out."""

        def found():
            return next((message for message in list(self.messages) if matches(message)), None)

        wait_until("a matching message", lambda: found() is not None)
        return found()


class AmclContractTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_amcl_contract")
        cls.robot = SimpleRobot(START)
        cls.poses = Received("amcl_pose", PoseWithCovarianceStamped)
        cls.transforms = Received("/tf", TFMessage)
        cls.initial_pose = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=2)
        cls.logs = Received("/rosout", Log)
        for service in ("global_localization", "request_nomotion_update", "set_map"):
            rospy.wait_for_service(service, 20.0)
        rospy.wait_for_service("amcl/get_loggers", 20.0)
        wait_until("amcl_lite to subscribe", cls.initial_pose.get_num_connections)

        def is_localized():
            cls.robot.sense()
            rospy.sleep(0.1)
            return cls.poses.messages

        wait_until("amcl_lite to start", is_localized)
        cls.logs.wait(lambda log: log.name == "/amcl")

    def setUp(self):
        self.set_pose(self.robot.base_in_map)

    def set_pose(self, pose, **how):
        """Publish an initial pose and wait until the node has accepted or rejected it.

        Earlier scans are processed by then, so that the next update belongs to the next scan.
        """
        self.map_to_odom(self.robot.sense() + POST_DATED)
        self.logs.messages.clear()
        self.publish_initial_pose(pose, **how)
        self.logs.wait(lambda log: log.msg.startswith(("Setting pose", "Ignoring initial pose")))

    def publish_initial_pose(self, pose, frame="map", stamp=None, spread=0.1):
        message = PoseWithCovarianceStamped()
        message.header.frame_id = frame
        message.header.stamp = stamp or rospy.Time(0)
        message.pose.pose = pose2_to_msg(pose)
        covariance = np.diag([spread**2, spread**2, 0, 0, 0, spread**2 / 4])
        message.pose.covariance = covariance.ravel().tolist()
        self.initial_pose.publish(message)

    def estimate(self):
        """Publish a scan that triggers an update and return the estimated pose."""
        stamp = self.robot.sense()
        return self.poses.wait(lambda pose: pose.header.stamp == stamp)

    def map_to_odom(self, stamp):
        def matches(message):
            transform = message.transforms[0]
            return transform.child_frame_id == "odom" and transform.header.stamp == stamp

        return self.transforms.wait(matches).transforms[0]

    def assert_near(self, message, pose):
        found = pose2_from_msg(message.pose.pose)
        self.assertLess(found.distance_to(pose), NEAR, f"{found} is not near {pose}")
        self.assertLess(abs(wrap(found.yaw - pose.yaw)), NEAR_ANGLE, f"{found} is not near {pose}")

    def test_topics_have_the_official_types(self):
        types = dict(rospy.get_published_topics())
        self.assertEqual(types["/amcl_pose"], "geometry_msgs/PoseWithCovarianceStamped")
        self.assertEqual(types["/particlecloud"], "geometry_msgs/PoseArray")

    def test_a_driving_robot_is_tracked_although_its_odometry_drifts(self):
        for step in range(12):
            self.robot.move(STEP if step < 6 else TURN, slip=Pose2(0.005, 0.0, 0.01))
            message = self.estimate()
        self.assert_near(message, self.robot.base_in_map)
        self.assertEqual(message.header.frame_id, "map")
        self.assertGreater(message.pose.covariance[0], 0.0)
        self.assertGreater(message.pose.covariance[35], 0.0)

    def test_every_scan_sends_a_post_dated_transform(self):
        self.estimate()
        for _ in range(3):
            stamp = self.robot.sense()
            transform = self.map_to_odom(stamp + POST_DATED)
            self.assertEqual(transform.header.frame_id, "map")
            rospy.sleep(0.05)

    def test_pose_and_cloud_are_latched(self):
        self.estimate()
        rospy.sleep(0.2)
        pose = rospy.wait_for_message("amcl_pose", PoseWithCovarianceStamped, PATIENCE_SECONDS)
        cloud = rospy.wait_for_message("particlecloud", PoseArray, PATIENCE_SECONDS)
        self.assertEqual(pose.header.stamp, self.poses.messages[-1].header.stamp)
        self.assertGreaterEqual(len(cloud.poses), 500)
        self.assertLess(pose2_from_msg(cloud.poses[0]).distance_to(self.robot.base_in_map), 1.0)

    def test_a_standing_robot_publishes_no_new_pose_until_asked(self):
        self.estimate()
        rospy.sleep(0.2)
        count = len(self.poses.messages)
        for _ in range(5):
            self.map_to_odom(self.robot.sense() + POST_DATED)
        self.assertEqual(len(self.poses.messages), count)
        rospy.ServiceProxy("request_nomotion_update", Empty)()
        self.estimate()

    def test_an_initial_pose_in_another_frame_is_ignored(self):
        self.estimate()
        self.set_pose(Pose2(6.0, 1.0, 1.0), frame="odom")
        self.robot.move(TURN)
        self.assert_near(self.estimate(), self.robot.base_in_map)

    def test_an_initial_pose_of_the_past_is_advanced_by_odometry(self):
        then, pose_then = self.robot.sense(), self.robot.base_in_map
        self.map_to_odom(then + POST_DATED)
        self.robot.move(Pose2(0.0, 0.0, math.pi / 2))
        self.map_to_odom(self.robot.sense() + POST_DATED)
        self.set_pose(pose_then, stamp=then, spread=0.01)
        self.assert_near(self.estimate(), self.robot.base_in_map)

    def test_a_scan_waits_for_a_transform_that_arrives_later(self):
        stamp = self.robot.sense(tf_late=0.3)
        self.poses.wait(lambda pose: pose.header.stamp == stamp)

    def test_scans_without_a_valid_beam_keep_the_estimate_finite(self):
        self.estimate()
        for value in (math.nan, math.inf, 0.0, -1.0):
            self.robot.move(TURN)
            stamp = self.robot.sense(ranges=np.full(BEAMS, value, dtype=np.float32))
            transform = self.map_to_odom(stamp + POST_DATED).transform
            self.assertTrue(math.isfinite(transform.translation.x + transform.rotation.w))
        self.robot.move(TURN)
        self.assert_near(self.estimate(), self.robot.base_in_map)

    def test_global_localization_spreads_the_particles_over_the_free_space(self):
        clouds = Received("particlecloud", PoseArray)
        rospy.ServiceProxy("global_localization", Empty)()
        self.robot.sense()
        cloud = clouds.wait(lambda cloud: np.ptp([pose.position.x for pose in cloud.poses]) > 6.0)
        for pose in cloud.poses[::100]:
            self.assertEqual(self.robot.grid.value_at(pose.position.x, pose.position.y), 0)

    def test_set_map_takes_the_map_and_then_the_pose(self):
        request = SetMapArrays._request_class()
        request.map = self.robot.map_message
        request.initial_pose.header.frame_id = "map"
        request.initial_pose.pose.pose = pose2_to_msg(self.robot.base_in_map)
        request.initial_pose.pose.covariance = 0.001 * np.eye(6).ravel()
        self.assertTrue(rospy.ServiceProxy("set_map", SetMapArrays)(request).success)
        self.assert_near(self.estimate(), self.robot.base_in_map)

    def test_the_pose_is_saved_as_the_next_start(self):
        self.estimate()

        def is_saved():
            self.robot.sense()
            rospy.sleep(0.15)
            saved = [rospy.get_param("/amcl/initial_pose_" + name) for name in "xya"]
            return Pose2(*saved).distance_to(self.robot.base_in_map) < NEAR

        wait_until("the pose to be saved", is_saved)
        self.assertGreater(rospy.get_param("/amcl/initial_cov_xx"), 0.0)

    def test_parameters_can_be_changed_and_restored_at_run_time(self):
        client = Client("amcl", timeout=PATIENCE_SECONDS)
        started_with = client.get_configuration(timeout=PATIENCE_SECONDS)
        self.assertEqual((started_with["max_particles"], started_with["transform_tolerance"]), (2000, 0.3))
        self.assertEqual(started_with["recovery_alpha_slow"], 0.001)
        self.estimate()
        changed = client.update_configuration({"max_particles": 700, "min_particles": 700})
        self.assertEqual(changed["max_particles"], 700)
        clouds = Received("particlecloud", PoseArray)
        self.robot.move(TURN)
        self.assert_near(self.estimate(), self.robot.base_in_map)
        clouds.wait(lambda cloud: len(cloud.poses) == 700)
        refused = client.update_configuration({"odom_model_type": "hover"})
        self.assertEqual(refused["odom_model_type"], "diff")
        restored = client.update_configuration({"restore_defaults": True})
        self.assertEqual((restored["max_particles"], restored["min_particles"]), (2000, 500))

    def test_diagnostics_report_the_spread_and_the_quality(self):
        diagnostics = Received("/diagnostics", DiagnosticArray)
        quality = Received("amcl/localization_quality", Float32)

        def confirms_pose():
            self.robot.move(TURN)
            self.map_to_odom(self.robot.sense() + POST_DATED)
            has_both = diagnostics.messages and quality.messages
            is_ok = has_both and diagnostics.messages[-1].status[0].level == DiagnosticStatus.OK
            return is_ok and quality.messages[-1].data > 0.9

        wait_until("diagnostics and quality", confirms_pose)
        spread, fit = diagnostics.messages[-1].status
        self.assertEqual((spread.name, spread.hardware_id), ("amcl: Standard deviation", "None"))
        keys = [value.key for value in spread.values]
        self.assertEqual(keys[:3], ["std_x", "std_y", "std_yaw"])
        self.assertEqual(keys[3:], ["std_warn_level_x", "std_warn_level_y", "std_warn_level_yaw"])
        self.assertEqual((spread.level, spread.message), (DiagnosticStatus.OK, "OK"))
        self.assertEqual(fit.message, "ok")
        state = rospy.wait_for_message("amcl/localization_state", String, PATIENCE_SECONDS)
        self.assertEqual(state.data, "ok")

    def test_frames_are_sent_without_a_leading_slash(self):
        transform = self.map_to_odom(self.robot.sense() + POST_DATED)
        self.assertEqual(transform.child_frame_id, frame_name(transform.child_frame_id))

    def test_invalid_messages_do_not_change_the_estimate(self):
        """Each of these once caused a segmentation fault or an endless loop."""
        for name in ("angle_min", "angle_increment", "range_max"):
            self.robot.sense(changed={name: math.nan})
        for far, spread in ((1e300, 0.1), (1e18, 0.1), (0.0, 1e150)):
            self.publish_initial_pose(Pose2(far, 0.0), spread=spread)
            self.robot.sense()
        self.poses.messages.clear()
        self.set_pose(self.robot.base_in_map)
        self.robot.sense()
        self.poses.wait(
            lambda message: pose2_from_msg(message.pose.pose).distance_to(self.robot.base_in_map) < NEAR
        )


if __name__ == "__main__":
    rostest.rosrun("home_service_tests", "amcl_contract", AmclContractTest)
