#!/usr/bin/env python3
"""Drive the turtle in a circle: publishes velocities at 10 Hz on /turtle1/cmd_vel."""

import rospy
from geometry_msgs.msg import Twist

FORWARD, TURN = 0.5, 0.2  # m/s and rad/s: a circle of 2.5 m radius


def main():
    rospy.init_node("turtle_velocity_publisher", anonymous=True)
    publisher = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=10)
    rate = rospy.Rate(10)
    twist = Twist()
    twist.linear.x, twist.angular.z = FORWARD, TURN
    while not rospy.is_shutdown():
        publisher.publish(twist)
        rospy.loginfo_throttle(1.0, "velocity command: %.2f m/s, %.2f rad/s", FORWARD, TURN)
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping
