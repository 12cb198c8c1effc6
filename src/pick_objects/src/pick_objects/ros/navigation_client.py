"""Inputs of the goal driver from topics, and its client of move_base."""

import math

import rospy
from home_service_msgs.msg import DetectedObjects
from nav_msgs.msg import Odometry
from std_msgs.msg import Float32

from pick_objects.goal_driver import GoalDriver
from planar.detection import Detection
from planar_ros.calls.move_base import MoveBaseClient
from planar_ros.messages.conversion import pose2_from_msg
from planar_ros.messages.validation import MessageError, subscribe

# Fit of each scan, published by amcl_lite; the official amcl does not publish it.
QUALITY_TOPIC = "amcl/localization_quality"
DETECTIONS_TOPIC = "detected_objects"


class NavigationClient:
    """Feeds a goal driver.

    Args:
        frame_id: Frame of the goals.
        detects: Whether objects are searched: then the topic of the detector is subscribed to.

    Attributes:
        move_base: Client of move_base.
        driver: The goal driver.
    """

    def __init__(self, frame_id: str, detects: bool = False):
        self.move_base = MoveBaseClient(frame_id)
        self.move_base.cancel_on_shutdown()
        self.driver = GoalDriver(self.move_base, rospy.logwarn)
        rospy.Subscriber(QUALITY_TOPIC, Float32, self._on_fit, queue_size=1)
        subscribe("odom", Odometry, self._on_odometry, queue_size=1)
        if detects:
            subscribe(DETECTIONS_TOPIC, DetectedObjects, self._on_detections, queue_size=1)

    def _on_fit(self, message: Float32) -> None:
        self.driver.add_fit(rospy.get_time(), message.data)

    def _on_odometry(self, message: Odometry) -> None:
        self.driver.odometry = pose2_from_msg(message.pose.pose)

    def _on_detections(self, message: DetectedObjects) -> None:
        for each in message.objects:
            at = each.position
            if not all(map(math.isfinite, (at.x, at.y, at.z))):
                raise MessageError(f"objects: the position of {each.name} is not finite")
        detections = (
            Detection(each.name, each.position.x, each.position.y, each.position.z)
            for each in message.objects
        )
        self.driver.add_detections(message.header.stamp.to_sec(), tuple(detections))
