"""A marker for each object of a mission: where it stands, or on the robot that carries it."""

import threading
from typing import Dict, List

import rospy
from home_service_msgs.msg import MissionState, ObjectState
from visualization_msgs.msg import Marker

from add_markers.boxes import HEIGHT, RIDING_HEIGHT
from add_markers.config import MarkerSettings
from add_markers.ros.simulator_boxes import SimulatedBoxes
from planar import Pose2
from planar_ros.messages.conversion import pose2_from_msg, pose2_to_msg
from planar_ros.messages.validation import subscribe
from planar_ros.node.readiness import ReadinessMonitor

STATE_TOPIC = "pick_objects/mission_state"


class MissionMarkers:
    """Publishes a marker for each object (namespace: the object's name); solid ones become boxes, too."""

    def __init__(self, settings: MarkerSettings):
        self._base_frame = settings.base_frame_id
        self._bodies = SimulatedBoxes(settings)
        self._placed: Dict[str, Pose2] = {}
        self._beside: Dict[str, Pose2] = {}
        self._shown: Dict[str, ObjectState] = {}
        self._frame_id = ""
        # rospy calls peer_subscribe in a separate thread, without the publisher's lock.
        self._showing = threading.Lock()
        # A latched topic would keep the marker of one object only; late subscribers get the latest of each.
        self._publisher = rospy.Publisher(
            "visualization_marker", Marker, subscriber_listener=_Repeater(self), queue_size=50
        )
        self._has_state = False
        subscribe(STATE_TOPIC, MissionState, self._follow, queue_size=50)
        ReadinessMonitor({f"a mission on {rospy.resolve_name(STATE_TOPIC)}": lambda: self._has_state})

    def repeat(self, publish) -> None:
        """Send the latest marker of each object to one subscriber."""
        with self._showing:
            for state in self._shown.values():
                publish(self._marker(state))

    def _follow(self, message: MissionState) -> None:
        self._has_state = True
        placed = dict(self._bodies.follow(message.objects))
        with self._showing:
            self._beside = {state.name: pose for state in message.objects for pose in self._room(state)}
            self._placed, self._frame_id = {**self._beside, **placed}, message.header.frame_id
            self._show({state.name: state for state in message.objects})

    def _room(self, state: ObjectState) -> List[Pose2]:
        """Return the pose beside the robot of an object that it has set down: it covers its place."""
        before = self._shown.get(state.name)
        if before is None or state.is_carried or state.is_solid:
            return []
        if before.is_carried:
            return [self._bodies.room_beside(pose2_from_msg(state.pose), state.size)]
        return [self._beside[state.name]] if state.name in self._beside else []

    def _show(self, objects: Dict[str, ObjectState]) -> None:
        for name in [name for name in self._shown if name not in objects]:
            self._publisher.publish(Marker(ns=name, action=Marker.DELETE))
            del self._shown[name]
        for name, state in objects.items():
            before = self._shown.get(name)
            if state != before:
                if before is not None and before.is_carried:
                    # rviz 1.14 crashes if a marker is no longer locked to its frame.
                    self._publisher.publish(Marker(ns=name, action=Marker.DELETE))
                self._shown[name] = state
                self._publisher.publish(self._marker(state))

    def _marker(self, state: ObjectState) -> Marker:
        marker = Marker(ns=state.name, id=0, type=Marker.CUBE, action=Marker.ADD, color=state.color)
        marker.scale.x = marker.scale.y = state.size
        marker.scale.z = HEIGHT if state.is_solid else state.size
        marker.pose.orientation.w = 1.0
        if state.is_carried:
            marker.header.frame_id, marker.frame_locked = self._base_frame, True
            marker.pose.position.z = RIDING_HEIGHT + marker.scale.z / 2.0
        else:
            marker.header.frame_id = self._frame_id
            marker.pose = pose2_to_msg(self._placed.get(state.name) or pose2_from_msg(state.pose))
            marker.pose.position.z = marker.scale.z / 2.0
        return marker


class _Repeater(rospy.SubscribeListener):
    def __init__(self, markers: MissionMarkers):
        self._markers = markers

    def peer_subscribe(self, topic_name, topic_publish, peer_publish):
        self._markers.repeat(peer_publish)
