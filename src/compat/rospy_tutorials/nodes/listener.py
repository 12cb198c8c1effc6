#!/usr/bin/env python3
"""Log the messages on the topic chatter."""

import rospy
from std_msgs.msg import String


def on_text(message):
    rospy.loginfo("I heard %s", message.data)


if __name__ == "__main__":
    rospy.init_node("listener", anonymous=True)
    rospy.Subscriber("chatter", String, on_text)
    rospy.spin()
