"""The node ``turtlebot3_drive``: wanders without hitting obstacles."""

import math

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

from planar import Pose2
from planar_ros.messages.conversion import pose2_from_msg
from planar_ros.node.runner import run
from planar_ros.node.topics import publish_on_shutdown
from turtlebot3_gazebo.wandering import Wanderer

SIDE = math.radians(30.0)


class DriveNode:
    """Publishes a velocity for each scan, and zero on shutdown."""

    def __init__(self) -> None:
        rospy.loginfo("TurtleBot3 Simulation Node Init")
        self._wanderer, self._base = Wanderer(), Pose2()
        topic = rospy.get_param("cmd_vel_topic_name", "cmd_vel")
        self._publisher = rospy.Publisher(topic, Twist, queue_size=10)
        publish_on_shutdown(self._publisher, Twist())
        rospy.Subscriber("odom", Odometry, self._on_odometry, queue_size=10)
        rospy.Subscriber("scan", LaserScan, self._on_scan, queue_size=1)

    def _on_odometry(self, message: Odometry) -> None:
        self._base = pose2_from_msg(message.pose.pose)

    def _on_scan(self, scan: LaserScan) -> None:
        ahead, left, right = (_range_at(scan, angle) for angle in (0.0, SIDE, -SIDE))
        velocity = self._wanderer.advance(ahead, left, right, self._base.yaw)
        message = Twist()
        message.linear.x, message.angular.z = velocity.v, velocity.omega
        if not rospy.is_shutdown():
            self._publisher.publish(message)


def _range_at(scan: LaserScan, angle: float) -> float:
    """Range at an angle of a full scan [m]; range_max without an echo."""
    turn = (angle - scan.angle_min) % math.tau
    number = round(turn / scan.angle_increment) % len(scan.ranges)
    distance = scan.ranges[number]
    return distance if math.isfinite(distance) else scan.range_max


def main() -> None:
    run("turtlebot3_drive", DriveNode)
