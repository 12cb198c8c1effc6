"""Zones as markers for rviz."""

import math
from typing import Iterable, List

import rospy
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from planar.maps.places import NamedPlace

CORNERS = 48
LINE_WIDTH, TEXT_HEIGHT = 0.05, 0.25
# Maps and costmaps are drawn below this height.
HEIGHT = 0.05
COLOUR = ColorRGBA(0.55, 0.3, 0.95, 1.0)


def publish_zones(places: Iterable[NamedPlace], frame_id: str) -> rospy.Publisher:
    """Publish the zones once, latched; return the publisher, with which they end."""
    publisher = rospy.Publisher("zones", MarkerArray, queue_size=1, latch=True)
    publisher.publish(zone_markers(places, frame_id))
    return publisher


def zone_markers(places: Iterable[NamedPlace], frame_id: str) -> MarkerArray:
    """Return for each place a ring of its radius, an arrow in the direction of its yaw, and its name."""
    markers: List[Marker] = []
    for number, place in enumerate(places):
        markers += [_ring(number, place), _arrow(number, place), _name(number, place)]
    for marker in markers:
        marker.header.frame_id = frame_id
        marker.color = COLOUR
        marker.pose.orientation.w = 1.0
    return MarkerArray(markers)


def _ring(number: int, place: NamedPlace) -> Marker:
    marker = Marker(ns="zones", id=number, type=Marker.LINE_STRIP)
    marker.scale.x = LINE_WIDTH
    angles = [2.0 * math.pi * corner / CORNERS for corner in range(CORNERS + 1)]
    marker.points = [_point(place, angle, place.radius) for angle in angles]
    return marker


def _arrow(number: int, place: NamedPlace) -> Marker:
    marker = Marker(ns="headings", id=number, type=Marker.ARROW)
    marker.scale.x, marker.scale.y = LINE_WIDTH, 3.0 * LINE_WIDTH
    marker.points = [_point(place, place.pose.yaw, reach * place.radius) for reach in (1.0, 1.6)]
    return marker


def _name(number: int, place: NamedPlace) -> Marker:
    marker = Marker(ns="names", id=number, type=Marker.TEXT_VIEW_FACING, text=place.name)
    marker.scale.z = TEXT_HEIGHT
    marker.pose.position.x = place.pose.x
    marker.pose.position.y = place.pose.y + place.radius + TEXT_HEIGHT
    marker.pose.position.z = TEXT_HEIGHT
    return marker


def _point(place: NamedPlace, angle: float, distance: float) -> Point:
    return Point(place.pose.x + distance * math.cos(angle), place.pose.y + distance * math.sin(angle), HEIGHT)
