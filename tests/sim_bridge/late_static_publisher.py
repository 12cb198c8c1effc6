#!/usr/bin/env python3
"""An unsynchronised node that publishes a static transform late, as on a busy machine."""

import time

import rospy
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

LATE_SECONDS = 1.0


def main():
    rospy.init_node("late_static_publisher")
    time.sleep(LATE_SECONDS)
    topic = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
    time.sleep(LATE_SECONDS)
    pose = Transform(Vector3(), Quaternion(w=1.0))
    topic.publish([TransformStamped(Header(frame_id="base_link"), "late", pose)])
    rospy.spin()


main()
