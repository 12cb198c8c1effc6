"""Laser scans, as points."""

import numpy as np

from cockpit.drawing import Drawing, Part, Points
from cockpit.layer import Layer

COLOUR = (230, 57, 70)


def draw(message) -> Drawing:
    ranges = np.asarray(message.ranges, dtype=float)
    with np.errstate(invalid="ignore"):  # angles may be anything
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
    thing = Points(points, COLOUR, 0.05)
    return Drawing((Part("scan", header.frame_id, thing, stamp=header.stamp.to_sec() or None),))


LAYER = Layer("Scan", ("sensor_msgs/LaserScan",), lambda: draw, shown=("scan",))
