"""What a Kobuki's bumper and cliff sensors feel, as points that costmaps can mark (kobuki_bumper2pc)."""

import math
from typing import FrozenSet

import numpy as np
import rospy
from sensor_msgs.msg import PointCloud2

from planar_ros.messages.clouds import cloud_msg
from sim_bridge.sensors.kobuki import CENTRE, LEFT, RIGHT, KobukiReading

FRAME = "base_link"
# As turtlebot_bringup sets it, and how far off a point lies that means "nothing there", m.
RADIUS, HEIGHT, FAR = 0.24, 0.04, 100.0
BEARINGS = {LEFT: math.radians(70.0), CENTRE: 0.0, RIGHT: -math.radians(70.0)}


class BumperCloud:
    """Makes a message as long as something is felt, and one more when nothing is any longer."""

    def __init__(self):
        self._felt: FrozenSet[int] = frozenset()

    def is_due(self, reading: KobukiReading) -> bool:
        before, self._felt = self._felt, reading.bumpers | reading.cliffs
        return bool(before or self._felt)

    @staticmethod
    def message(reading: KobukiReading, stamp: rospy.Time, frame: str) -> PointCloud2:
        """Three points: left, centre, right."""
        felt = reading.bumpers | reading.cliffs
        reach = np.array([RADIUS if sector in felt else FAR for sector in BEARINGS])
        bearings = np.array(list(BEARINGS.values()))
        columns = (reach * np.cos(bearings), reach * np.sin(bearings), np.full(len(reach), HEIGHT))
        return cloud_msg(columns, "xyz", stamp, frame)
