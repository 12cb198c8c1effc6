"""Bags with malformed scans."""

import math

import rosbag
from genpy import Time

NEVER = Time(2**32 - 1, 999_999_999)
# Number of malformed scans.
BROKEN = 3


def break_scans(source, target, topic="/scan"):
    """Copy a bag; two scans get NaN angles, and one the latest stamp that ROS can represent."""
    number = 0
    with rosbag.Bag(str(source)) as whole, rosbag.Bag(str(target), "w") as broken:
        for name, message, at in whole.read_messages():
            if name == topic:
                number += 1
                if number == 4:
                    message.angle_increment = math.nan
                elif number == 6:
                    message.angle_min = math.nan
                elif number == 8:
                    message.header.stamp = NEVER
            broken.write(name, message, at)
