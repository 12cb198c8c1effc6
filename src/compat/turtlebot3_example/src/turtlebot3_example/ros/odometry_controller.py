"""Control of a robot along poses by odometry."""

import time
from typing import Callable, Iterable, Optional

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

from planar import Pose2, Twist2
from planar_ros.messages.conversion import pose2_from_msg
from planar_ros.node.topics import publish_on_shutdown
from turtlebot3_example.go_to_pose import velocity_to

RATE, ODOMETRY_SECONDS, POLL_SECONDS = 15.0, 60.0, 0.02


class OdometryController:
    """Subscribes to ``odom``, publishes ``cmd_vel``."""

    def __init__(self) -> None:
        self._base: Optional[Pose2] = None
        self._publisher = rospy.Publisher("cmd_vel", Twist, queue_size=5)
        publish_on_shutdown(self._publisher, Twist())
        rospy.Subscriber("odom", Odometry, self._on_odometry, queue_size=1)

    def base_in_odom(self) -> Pose2:
        """Pose of the robot in ``odom``. Raises rospy.ROSException if there is no odometry."""
        deadline = time.monotonic() + ODOMETRY_SECONDS
        while self._base is None:
            if rospy.is_shutdown():
                raise rospy.ROSInterruptException("interrupted")
            if time.monotonic() > deadline:
                raise rospy.ROSException(f"no odometry received on {rospy.resolve_name('odom')}")
            time.sleep(POLL_SECONDS)
        return self._base

    def follow(
        self, poses: Iterable[Pose2], align_yaw: bool, should_continue: Callable[[], bool] = lambda: True
    ) -> bool:
        """Drive to poses in order.

        Args:
            poses: Poses in ``odom``.
            align_yaw: Whether the robot turns to the yaw of each pose.
            should_continue: Called in each period; False stops the robot.

        Returns:
            Whether all poses were reached.
        """
        rate = rospy.Rate(RATE)
        for goal in poses:
            velocity = velocity_to(self.base_in_odom(), goal, align_yaw)
            while velocity is not None:
                if rospy.is_shutdown() or not should_continue():
                    self.stop()
                    return False
                self.drive(velocity)
                rate.sleep()
                velocity = velocity_to(self.base_in_odom(), goal, align_yaw)
        self.stop()
        return True

    def drive(self, velocity: Twist2) -> None:
        message = Twist()
        message.linear.x, message.angular.z = velocity.v, velocity.omega
        self._publisher.publish(message)

    def stop(self) -> None:
        self.drive(Twist2())

    def _on_odometry(self, message: Odometry) -> None:
        self._base = pose2_from_msg(message.pose.pose)
