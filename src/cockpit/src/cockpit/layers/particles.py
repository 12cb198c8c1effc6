"""Pose arrays such as the particle cloud: a short line for each pose."""

import numpy as np

from cockpit.drawing import LayerUpdate, LineSegments, PlacedShape
from cockpit.layer import DisplayLayer

LENGTH, HEIGHT, MOST = 0.12, 0.05, 3000
COLOUR = (120, 80, 220)


def draw(message) -> LayerUpdate:
    poses = message.poses[:: len(message.poses) // MOST + 1]
    fields = [
        (p.position.x, p.position.y, p.orientation.x, p.orientation.y, p.orientation.z, p.orientation.w)
        for p in poses
    ]
    x, y, qx, qy, qz, qw = np.array(fields, dtype=float).reshape(-1, 6).T
    yaw = np.arctan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz))
    starts = np.column_stack((x, y, np.full(len(x), HEIGHT)))
    ends = starts + LENGTH * np.column_stack((np.cos(yaw), np.sin(yaw), np.zeros(len(x))))
    segments = np.stack((starts, ends), axis=1)
    segments = segments[np.isfinite(segments).all(axis=(1, 2))]
    return LayerUpdate((PlacedShape("poses", message.header.frame_id, LineSegments(segments, COLOUR, 2.0)),))


LAYER = DisplayLayer(
    "Particles", ("geometry_msgs/PoseArray",), lambda: draw, shown=("particlecloud",), seconds=0.2
)
