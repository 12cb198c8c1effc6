#!/usr/bin/env python3
"""A small graph to look at: numbers, pictures, transforms, words, a service, parameters that can be tuned."""

import math
import time
from dataclasses import dataclass

import rospy
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import Image
from std_msgs.msg import Float64, String
from std_srvs.srv import SetBool, SetBoolResponse
from tf2_msgs.msg import TFMessage

from planar.config.parameters import POSITIVE, parameter
from planar_ros.node.parameters import SettingsReconfigureServer


@dataclass(frozen=True)
class Settings:
    gain: float = parameter(2.0, "what the sine is multiplied by", "", POSITIVE, dynamic=10.0)


class Stage:
    def __init__(self):
        self.settings = Settings()
        self._number = rospy.Publisher("/sine", Float64, queue_size=5)
        self._image = rospy.Publisher("/camera/image", Image, queue_size=1)
        self._frames = rospy.Publisher("/tf", TFMessage, queue_size=5)
        self._replies = rospy.Publisher("/replies", String, queue_size=5, latch=True)
        rospy.Subscriber("/words", String, lambda message: self._replies.publish(f"received {message.data}"))
        rospy.Service("/switch", SetBool, self._switch)
        SettingsReconfigureServer(self.settings, self._tune)

    def run(self):
        for turn in range(10**9):
            if rospy.is_shutdown():
                return
            now = rospy.get_rostime()
            self._number.publish(self.settings.gain * math.sin(now.to_sec()))
            self._frames.publish(TFMessage([frame(now)]))
            if turn % 4 == 0:
                self._image.publish(picture(turn))
                rospy.logwarn("turn %d <b>of the stage</b>", turn)
            time.sleep(0.05)

    def _switch(self, request):
        return SetBoolResponse(success=request.data, message=f"switched {request.data}")

    def _tune(self, values):
        self.settings = Settings(**values)
        return values


def frame(now):
    found = TransformStamped(child_frame_id="base_link")
    found.header.frame_id, found.header.stamp = "odom", now
    found.transform.rotation.w = 1.0
    return found


def picture(turn):
    rows = bytearray(b"\x20\x80\xc0" * 64 * 48)
    rows[: turn % 48 * 64 * 3] = b"\xf0\x60\x20" * 64 * (turn % 48)
    return Image(width=64, height=48, step=64 * 3, encoding="rgb8", data=bytes(rows))


if __name__ == "__main__":
    rospy.init_node("stage")
    Stage().run()
