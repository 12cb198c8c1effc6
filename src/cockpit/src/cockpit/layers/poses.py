"""Poses and points: goals, estimates with their covariance, odometry."""

import numpy as np

from cockpit.drawing import LayerUpdate, LineSegments, PlacedShape
from cockpit.frames import pose_matrix
from cockpit.layer import DisplayLayer

COLOUR = (255, 140, 0)
LENGTH, HEAD, HEIGHT = 0.45, 0.14, 0.06


def arrow(length: float = LENGTH, head: float = HEAD) -> np.ndarray:
    """Return a flat arrow along x from the origin.

    Args:
        length: Length of the arrow [m].
        head: Length of its head [m].

    Returns:
        Segments (3, 2, 3) [m].
    """
    tip = (length, 0.0, 0.0)
    ends = [(0.0, 0.0, 0.0), (length - head, head * 0.6, 0.0), (length - head, -head * 0.6, 0.0)]
    return np.array([(end, tip) for end in ends])


def ellipse(covariance: np.ndarray, sigmas: float = 2.0) -> np.ndarray:
    """Return the confidence ellipse of a covariance.

    Args:
        covariance: Covariance (2, 2) of x and y [m^2].
        sigmas: Size of the ellipse, as a number of standard deviations.

    Returns:
        Segments (32, 2, 3) around the origin [m].
    """
    values, vectors = np.linalg.eigh((covariance + covariance.T) / 2.0)
    angles = np.linspace(0.0, 2.0 * np.pi, 33)
    circle = np.stack((np.cos(angles), np.sin(angles)))
    outline = (vectors * (sigmas * np.sqrt(np.maximum(values, 0.0)))) @ circle
    points = np.column_stack((outline.T, np.zeros(33)))
    return np.stack((points[:-1], points[1:]), axis=1)


def draw(message) -> LayerUpdate:
    """Draw a PoseStamped, PoseWithCovarianceStamped, Odometry or PointStamped."""
    if hasattr(message, "point"):
        point = message.point
        pose, parts = pose_matrix((point.x, point.y, point.z), (0, 0, 0, 1)), [arrow(0.01)]
    else:
        with_covariance = hasattr(message.pose, "covariance")
        pose_message = message.pose.pose if with_covariance else message.pose
        q = pose_message.orientation
        pose = pose_matrix((pose_message.position.x, pose_message.position.y, HEIGHT), (q.x, q.y, q.z, q.w))
        parts = [arrow()]
    if pose is None:
        return LayerUpdate(warning="the pose is not finite, or its quaternion is zero")
    frame = message.header.frame_id
    lines = [PlacedShape("arrow", frame, LineSegments(np.concatenate(parts), COLOUR, 6.0), pose)]
    covariance = getattr(message.pose, "covariance", None) if hasattr(message, "pose") else None
    if covariance is not None and np.isfinite(covariance).all():
        flat = np.reshape(covariance, (6, 6))[:2, :2]
        place = np.eye(4)
        place[:3, 3] = pose[:3, 3]
        lines.append(PlacedShape("ellipse", frame, LineSegments(ellipse(flat), (180, 120, 255), 3.0), place))
    return LayerUpdate(tuple(lines))


LAYER = DisplayLayer(
    "Poses",
    (
        "geometry_msgs/PoseStamped",
        "geometry_msgs/PoseWithCovarianceStamped",
        "geometry_msgs/PointStamped",
        "nav_msgs/Odometry",
    ),
    lambda: draw,
    shown=("current_goal", "clicked_point"),
)
