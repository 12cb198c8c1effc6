"""Zones in ROS: a service that switches each zone, and markers for rviz."""

import rospy
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from std_srvs.srv import SetBool, SetBoolResponse
from visualization_msgs.msg import Marker, MarkerArray

from move_base_lite.navigator.zones import KEEP_OUT, NavigationZone, Zones

RED, YELLOW, GREY = (0.9, 0.1, 0.1), (0.9, 0.8, 0.1), (0.5, 0.5, 0.5)
LINE_WIDTH = 0.05


class ZoneTopics:
    """Serves ``~zones/<name>`` (std_srvs/SetBool) for each zone and publishes ``~zones/markers``, latched."""

    def __init__(self, zones: Zones, map_frame: str):
        """Advertise a service for each zone, and publish the markers.

        Args:
            zones: Zones to switch.
            map_frame: Frame of the markers.
        """
        self._zones, self._map_frame = zones, map_frame
        self._markers = rospy.Publisher("~zones/markers", MarkerArray, queue_size=1, latch=True)
        for zone in zones.all:
            rospy.Service(
                f"~zones/{zone.name}", SetBool, lambda request, zone=zone: self._on_switch(zone, request)
            )
        if zones.all:
            self._publish()

    def _on_switch(self, zone: NavigationZone, request):
        self._zones.enable(zone.name, request.data)
        self._publish()
        text = f"zone {zone.name} ({zone.kind}) is {'on' if request.data else 'off'}"
        rospy.loginfo(text)
        return SetBoolResponse(True, text)

    def _publish(self):
        markers = [self._marker(number, zone) for number, zone in enumerate(self._zones.all)]
        self._markers.publish(MarkerArray(markers))

    def _marker(self, number: int, zone: NavigationZone) -> Marker:
        marker = Marker(ns="zones", id=number, type=Marker.LINE_STRIP, action=Marker.ADD)
        marker.header.frame_id = self._map_frame
        marker.pose.orientation.w = 1.0
        marker.scale.x = LINE_WIDTH
        colour = RED if zone.kind == KEEP_OUT else YELLOW
        marker.color = ColorRGBA(*(colour if self._zones.is_enabled(zone.name) else GREY), 1.0)
        marker.points = [Point(x, y, 0.0) for x, y in (*zone.corners, zone.corners[0])]
        return marker
