#!/usr/bin/env python3
"""Log the messages on /company_info."""

import rospy
from learning_topic.msg import Information


def on_information(message):
    rospy.loginfo_throttle(
        1.0, "company info: %s in %s, %d employees", message.company, message.city, message.employees
    )


if __name__ == "__main__":
    rospy.init_node("Information_subscriber", anonymous=True)
    rospy.Subscriber("/company_info", Information, on_information)
    rospy.spin()
