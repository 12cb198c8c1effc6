#!/usr/bin/env python3
"""Publish a text on the topic chatter, ten times a second."""

import rospy
from std_msgs.msg import String


def talk():
    publisher = rospy.Publisher("chatter", String, queue_size=10)
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        text = f"hello world {rospy.get_time():.2f}"
        rospy.loginfo(text)
        publisher.publish(text)
        rate.sleep()


if __name__ == "__main__":
    rospy.init_node("talker", anonymous=True)
    try:
        talk()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping
