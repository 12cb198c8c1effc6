"""Plans and trajectories, as lines."""

import numpy as np

from cockpit.drawing import LayerUpdate, LineSegments, PlacedShape
from cockpit.layer import DisplayLayer

HEIGHT = 0.04
COLOUR = (46, 160, 67)


def draw(message) -> LayerUpdate:
    """Draw the path through the finite positions of a nav_msgs/Path, slightly above the floor.

    The frame is that of the path or, if it is empty, of its first pose.
    """
    points = np.array([(pose.pose.position.x, pose.pose.position.y, HEIGHT) for pose in message.poses])
    points = points.reshape(-1, 3)
    points = points[np.isfinite(points).all(axis=1)]
    segments = np.stack((points[:-1], points[1:]), axis=1)
    frame = message.header.frame_id or (message.poses[0].header.frame_id if message.poses else "")
    return LayerUpdate((PlacedShape("path", frame, LineSegments(segments, COLOUR, 4.0)),))


LAYER = DisplayLayer("Paths", ("nav_msgs/Path",), lambda: draw, shown=("plan", "path"), seconds=0.2)
