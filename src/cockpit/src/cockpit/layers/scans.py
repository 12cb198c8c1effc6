"""Laser scans, as points."""

import numpy as np

from cockpit.drawing import LayerUpdate, PlacedShape, PointCloudShape
from cockpit.layer import DisplayLayer

COLOUR = (230, 57, 70)


def draw(message) -> LayerUpdate:
    ranges = np.asarray(message.ranges, dtype=float)
    with np.errstate(invalid="ignore"):  # angles of a malformed scan may be infinite
        angles = message.angle_min + message.angle_increment * np.arange(len(ranges))
    seen = (
        np.isfinite(ranges)
        & np.isfinite(angles)
        & (ranges >= message.range_min)
        & (ranges <= message.range_max)
    )
    ranges, angles = ranges[seen], angles[seen]
    points = np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles), np.zeros(len(ranges))))
    header = message.header
    shape = PointCloudShape(points, COLOUR, 0.05)
    return LayerUpdate((PlacedShape("scan", header.frame_id, shape, stamp=header.stamp.to_sec() or None),))


LAYER = DisplayLayer("Scan", ("sensor_msgs/LaserScan",), lambda: draw, shown=("scan",))
