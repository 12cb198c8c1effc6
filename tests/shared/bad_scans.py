"""Bags in which some scans mean nothing."""

import math

import rosbag
from genpy import Time

NEVER = Time(2**32 - 1, 999_999_999)
# How many scans are broken.
BROKEN = 3


def break_scans(source, target, topic="/scan"):
    """Copies a bag; the directions of two of its scans are no numbers then, and one is of the end of time."""
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
