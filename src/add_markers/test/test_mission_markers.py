"""A subscriber that connects while a marker changes receives complete markers, the latest last."""

import copy
import io
import struct
import threading
from types import SimpleNamespace

import pytest
from home_service_msgs.msg import MissionState, ObjectState
from visualization_msgs.msg import Marker

from add_markers import MarkerSettings
from add_markers.ros import mission_markers
from add_markers.ros.mission_markers import MissionMarkers
from planar import Pose2

GIVING_WAY_SECONDS, DEADLINE = 0.3, 5.0


class Subscriber:
    """The near end of a connection, which keeps what is written to it."""

    def __init__(self):
        self._written = io.BytesIO()

    def write(self, data):
        self._written.write(data)

    def markers(self):
        """What a subscriber would read."""
        self._written.seek(0)
        found = []
        while head := self._written.read(4):
            (size,) = struct.unpack("<I", head)
            found.append(Marker().deserialize(self._written.read(size)))
        return found


class Publisher:
    """As rospy's, without a master: a listener may publish while another thread does (see rospy_transport).

    Messages are written to one buffer, from which they are sent.
    """

    def __init__(self, name, kind, subscriber_listener, queue_size):
        self._name, self._listener = name, subscriber_listener
        self._lock, self._buffer = threading.RLock(), io.BytesIO()
        self._subscribers = []

    def connect(self, subscriber):
        self._subscribers.append(subscriber)
        self._listener.peer_subscribe(self._name, self.publish, lambda one: self._write(one, [subscriber]))

    def publish(self, message):
        with self._lock:
            self._write(message, self._subscribers)

    def _write(self, message, subscribers):
        start = self._buffer.tell()
        self._buffer.seek(start + 4)
        message.serialize(self._buffer)
        end = self._buffer.tell()
        self._buffer.seek(start)
        self._buffer.write(struct.pack("<I", end - start - 4))
        for subscriber in subscribers:
            subscriber.write(self._buffer.getvalue())
        self._buffer.seek(0)
        self._buffer.truncate(0)


@pytest.fixture
def markers(monkeypatch):
    bodies = SimpleNamespace(
        follow=lambda objects: {}, room_beside=lambda robot, size: robot @ Pose2(0.5, 0.0)
    )
    monkeypatch.setattr(mission_markers, "SimulatedBoxes", lambda settings: bodies)
    monkeypatch.setattr(mission_markers, "ReadinessMonitor", lambda conditions: None)
    monkeypatch.setattr(mission_markers, "subscribe", lambda *_, **__: None)
    monkeypatch.setattr(mission_markers.rospy, "Publisher", Publisher)
    return MissionMarkers(MarkerSettings(zones_file="none"))


def mission_with_cube_at(x):
    message = MissionState(objects=[ObjectState(name="cube", size=0.2)])
    message.objects[0].pose.position.x = x
    message.objects[0].pose.orientation.w = 1.0
    return message


def test_an_object_that_is_set_down_is_shown_beside_the_robot_and_stays_there(markers):
    subscriber = Subscriber()
    markers._publisher.connect(subscriber)
    mission = mission_with_cube_at(1.0)
    markers._follow(copy.deepcopy(mission))
    mission.objects[0].is_carried = True
    markers._follow(copy.deepcopy(mission))
    mission.objects[0].is_carried = False
    mission.objects[0].pose.position.x = 3.0
    for size in (0.2, 0.3):  # another change makes it published again
        mission.objects[0].size = size
        markers._follow(copy.deepcopy(mission))
    shown = [marker for marker in subscriber.markers() if marker.action == Marker.ADD]
    assert [marker.pose.position.x for marker in shown if not marker.frame_locked] == [1.0, 3.5, 3.5]


def test_a_marker_that_changes_while_it_is_repeated(markers, monkeypatch):
    markers._follow(mission_with_cube_at(1.0))
    late = Subscriber()
    repeating = threading.Thread(target=markers._publisher.connect, args=[late], daemon=True)
    is_half_written, is_changed = threading.Event(), threading.Event()

    class GivingWay(Marker):
        def serialize(self, buff):
            super().serialize(buff)
            if threading.current_thread() is repeating:
                is_half_written.set()
                is_changed.wait(GIVING_WAY_SECONDS)

    monkeypatch.setattr(mission_markers, "Marker", GivingWay)
    repeating.start()
    assert is_half_written.wait(DEADLINE)
    markers._follow(mission_with_cube_at(2.0))
    is_changed.set()
    repeating.join(DEADLINE)
    assert [marker.pose.position.x for marker in late.markers()] == [1.0, 2.0]
