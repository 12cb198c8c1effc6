"""Point cloud of pressed bumpers and detected cliffs, for costmaps (kobuki_bumper2pc)."""

import math
from typing import FrozenSet

import numpy as np
import rospy
from sensor_msgs.msg import PointCloud2

from planar_ros.messages.conversion import cloud_msg
from sim_bridge.sensors.kobuki import CENTRE, LEFT, RIGHT, KobukiReading

FRAME = "base_link"
# Position of a point as set by turtlebot_bringup, and the distance of the point of an inactive sector [m].
RADIUS, HEIGHT, FAR = 0.24, 0.04, 100.0
BEARINGS = {LEFT: math.radians(70.0), CENTRE: 0.0, RIGHT: -math.radians(70.0)}


class BumperCloud:
    """Point cloud of the active sectors, due while a sector is active and once more afterwards."""

    def __init__(self):
        self._active: FrozenSet[int] = frozenset()

    def is_due(self, reading: KobukiReading) -> bool:
        before, self._active = self._active, reading.bumpers | reading.cliffs
        return bool(before or self._active)

    @staticmethod
    def message(reading: KobukiReading, stamp: rospy.Time, frame: str) -> PointCloud2:
        """Return a cloud of three points: left, centre, right; those of inactive sectors are far away.

        Args:
            reading: Pressed and cliff sectors.
            stamp: Time of the measurement.
            frame: Frame of the points, the base.
        """
        active = reading.bumpers | reading.cliffs
        reach = np.array([RADIUS if sector in active else FAR for sector in BEARINGS])
        bearings = np.array(list(BEARINGS.values()))
        columns = (reach * np.cos(bearings), reach * np.sin(bearings), np.full(len(reach), HEIGHT))
        return cloud_msg(columns, "xyz", stamp, frame)
