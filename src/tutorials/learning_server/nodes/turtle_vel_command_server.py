#!/usr/bin/env python3
"""Start and stop the turtle: each call of the service /turtle_vel_command toggles whether it drives."""

import rospy
from geometry_msgs.msg import Twist
from std_srvs.srv import Trigger, TriggerResponse

FORWARD, TURN = 0.5, 0.2


class TurtleCommand:
    def __init__(self):
        self._drives = False
        self._publisher = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=10)
        rospy.Service("/turtle_vel_command", Trigger, self._on_call)

    def drive(self):
        rate = rospy.Rate(10)
        twist = Twist()
        twist.linear.x, twist.angular.z = FORWARD, TURN
        while not rospy.is_shutdown():
            if self._drives:
                self._publisher.publish(twist)
            rate.sleep()

    def _on_call(self, request):
        self._drives = not self._drives
        if not self._drives:
            self._publisher.publish(Twist())
        rospy.loginfo("the turtle %s", "drives" if self._drives else "stands")
        return TriggerResponse(success=True, message="driving" if self._drives else "standing")


if __name__ == "__main__":
    rospy.init_node("turtle_vel_command_server")
    try:
        TurtleCommand().drive()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping
