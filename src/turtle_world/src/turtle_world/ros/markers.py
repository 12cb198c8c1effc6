"""Markers of turtles, floor and strokes for rviz and the cockpit, in the frame ``world``."""

import math

import rospy
from geometry_msgs.msg import Point, Quaternion
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from turtle_world.canvas import FLOOR_SIDE, PIXELS_PER_METRE, Color
from turtle_world.physics import HEIGHT, RADIUS
from turtle_world.world import TurtleWorld

FRAME = "world"
BODY_COLOR: Color = (0x2E, 0x2E, 0x2E)
# Height of strokes above the floor [m].
STROKE_HEIGHT = 0.01
FLOOR_THICKNESS = 0.02
# Limit for all strokes together, to bound the message size; the image contains all of them.
MAX_POINTS = 5000


class TurtleMarkers:
    """Publishes the markers while there are subscribers."""

    def __init__(self):
        self._publisher = rospy.Publisher("~markers", MarkerArray, queue_size=1)

    def publish(self, world: TurtleWorld) -> None:
        if self._publisher.get_num_connections() == 0:
            return
        markers = [Marker(action=Marker.DELETEALL), _floor(world.canvas.background)]
        for number, name in enumerate(world.names):
            markers += [_body(number, world.pose_of(name)), _heading_arrow(number, world.pose_of(name))]
        markers += [
            _line(number, stroke) for number, stroke in enumerate(world.canvas.latest_strokes(MAX_POINTS))
        ]
        self._publisher.publish(markers)


def _floor(color):
    marker = _marker("floor", 0, Marker.CUBE, color)
    marker.scale.x = marker.scale.y = FLOOR_SIDE
    marker.scale.z = FLOOR_THICKNESS
    marker.pose.position = Point(0.5 * FLOOR_SIDE, 0.5 * FLOOR_SIDE, -0.5 * FLOOR_THICKNESS)
    return marker


def _body(number, pose):
    marker = _marker("turtles", number, Marker.CYLINDER, BODY_COLOR)
    marker.scale.x = marker.scale.y = 2.0 * RADIUS
    marker.scale.z = HEIGHT
    marker.pose.position = Point(pose.x, pose.y, 0.5 * HEIGHT)
    return marker


def _heading_arrow(number, pose):
    marker = _marker("noses", number, Marker.ARROW, (255, 255, 255))
    marker.scale.x, marker.scale.y, marker.scale.z = 2.0 * RADIUS, 0.05, 0.05
    marker.pose.position = Point(pose.x, pose.y, HEIGHT)
    marker.pose.orientation = Quaternion(0.0, 0.0, math.sin(0.5 * pose.theta), math.cos(0.5 * pose.theta))
    return marker


def _line(number, stroke):
    marker = _marker("strokes", number, Marker.LINE_STRIP, stroke.pen.color)
    marker.scale.x = stroke.pen.width / PIXELS_PER_METRE
    marker.points = [Point(x, y, STROKE_HEIGHT) for x, y in stroke.points]
    return marker


def _marker(namespace, number, kind, color):
    marker = Marker(ns=namespace, id=number, type=kind, action=Marker.ADD)
    marker.header.stamp, marker.header.frame_id = rospy.Time.now(), FRAME
    marker.pose.orientation.w = 1.0
    marker.color = ColorRGBA(*(value / 255.0 for value in color), 1.0)
    return marker
