#!/usr/bin/env python3
"""Publish messages of this package's type, learning_topic/Information, on /company_info."""

import rospy
from learning_topic.msg import Information


def main():
    rospy.init_node("Information_publisher", anonymous=True)
    publisher = rospy.Publisher("/company_info", Information, queue_size=10)
    rate = rospy.Rate(10)
    message = Information(company="Home Service", city="Sindelfingen", employees=42)
    while not rospy.is_shutdown():
        publisher.publish(message)
        rospy.loginfo_throttle(1.0, "published: %s in %s", message.company, message.city)
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping
