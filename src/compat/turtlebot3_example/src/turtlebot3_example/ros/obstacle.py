"""The node ``turtlebot3_obstacle``: drives ahead and stops before obstacles."""

import math

import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

from planar_ros.node.runner import run
from planar_ros.node.topics import publish_on_shutdown

# Speed [m/s], and distance at which to stop, including the lidar's error [m].
SPEED, SAFE_DISTANCE = 0.22, 0.25


class ObstacleStop:
    """Publishes a velocity for each scan."""

    def __init__(self) -> None:
        self._is_moving = True
        self._publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        publish_on_shutdown(self._publisher, Twist())
        rospy.Subscriber("scan", LaserScan, self._on_scan, queue_size=1)

    def _on_scan(self, scan: LaserScan) -> None:
        ahead = scan.ranges[0] if scan.ranges else math.nan
        ahead = 0.0 if math.isnan(ahead) else min(ahead, scan.range_max)
        message = Twist()
        if ahead < SAFE_DISTANCE:
            if self._is_moving:
                rospy.loginfo("Stop!")
            self._is_moving = False
        else:
            self._is_moving = True
            message.linear.x = SPEED
            rospy.loginfo("Distance of the obstacle : %f", ahead)
        self._publisher.publish(message)


def main() -> None:
    run("turtlebot3_obstacle", ObstacleStop)
