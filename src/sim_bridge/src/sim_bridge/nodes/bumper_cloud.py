"""What a Kobuki's bumper and cliff sensors feel, as points that costmaps can mark (kobuki_bumper2pc)."""

import math

import numpy as np
from sensor_msgs.msg import PointCloud2, PointField

from sim_bridge.sensors.bumper import CENTRE, LEFT, RIGHT
from sim_bridge.sensors.kobuki import KobukiReading

FRAME = "base_link"
# As turtlebot_bringup sets it, and how far off a point lies that means "nothing there", m.
RADIUS, HEIGHT, FAR = 0.24, 0.04, 100.0
BEARINGS = {LEFT: math.radians(70.0), CENTRE: 0.0, RIGHT: -math.radians(70.0)}
FIELDS = [PointField(name, 4 * number, PointField.FLOAT32, 1) for number, name in enumerate("xyz")]


class BumperCloud:
    """Makes a message as long as something is felt, and one more when nothing is any longer."""

    def __init__(self):
        self._felt = frozenset()

    def is_due(self, reading: KobukiReading) -> bool:
        before, self._felt = self._felt, reading.bumpers | reading.cliffs
        return bool(before or self._felt)

    @staticmethod
    def message(reading: KobukiReading) -> PointCloud2:
        """Three points: left, centre, right."""
        felt = reading.bumpers | reading.cliffs
        points_xyz = np.array(
            [
                (reach * math.cos(bearing), reach * math.sin(bearing), HEIGHT)
                for sector, bearing in BEARINGS.items()
                for reach in [RADIUS if sector in felt else FAR]
            ],
            dtype="<f4",
        )
        return PointCloud2(
            height=1,
            width=len(points_xyz),
            fields=FIELDS,
            is_bigendian=False,
            point_step=points_xyz.strides[0],
            row_step=points_xyz.nbytes,
            data=points_xyz.tobytes(),
            is_dense=True,
        )
