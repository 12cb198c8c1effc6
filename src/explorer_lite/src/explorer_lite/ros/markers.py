"""Frontiers as markers for rviz."""

from typing import Iterable, List

from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from explorer_lite.frontiers import Frontier

POINT_SIZE = 0.05
BLUE, RED = ColorRGBA(0.1, 0.3, 1.0, 1.0), ColorRGBA(1.0, 0.2, 0.1, 1.0)


def frontier_markers(
    open_frontiers: List[Frontier], unreachable: List[Frontier], frame_id: str
) -> MarkerArray:
    """Return the frontiers as points, open ones in blue and unreachable ones in red.

    Args:
        open_frontiers: Frontiers with a viewpoint.
        unreachable: Frontiers without one.
        frame_id: Frame of the map.
    """
    return MarkerArray([_points(0, open_frontiers, BLUE, frame_id), _points(1, unreachable, RED, frame_id)])


def _points(number: int, frontiers: Iterable[Frontier], color: ColorRGBA, frame_id: str) -> Marker:
    marker = Marker(ns="frontiers", id=number, type=Marker.POINTS, color=color)
    marker.header.frame_id = frame_id
    marker.pose.orientation.w = 1.0
    marker.scale.x = marker.scale.y = POINT_SIZE
    marker.points = [Point(x, y, 0.0) for frontier in frontiers for x, y in frontier.points_xy.tolist()]
    if not marker.points:
        marker.action = Marker.DELETE
    return marker
