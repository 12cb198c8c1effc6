"""Markers of a project are read from whatever topic and type they are published on."""

from io import BytesIO

from geometry_msgs.msg import Pose, Vector3
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from evaluation.ros.message_events import Reception
from run_project.ros.observer import MarkerReader

RECEIVED = Reception(2.0, "/markers")


class Raw:
    """A message as rospy.AnyMsg."""

    def __init__(self, message):
        stream = BytesIO()
        message.serialize(stream)
        self._buff = stream.getvalue()
        self._connection_header = {"type": message._type}


def marker(number, x=1.0):
    pose = Pose()
    pose.position.x = x
    return Marker(ns="cube", id=number, pose=pose, scale=Vector3(0.1, 0.1, 0.1), color=ColorRGBA(1, 0, 0, 1))


def read(reader, message):
    return [(event.stamp, event.number, event.position[0]) for event in reader(Raw(message), RECEIVED)]


def test_a_marker_that_is_published_again_is_read_once_whatever_its_stamp():
    reader, again = MarkerReader(), marker(1)
    again.header.seq, again.header.stamp.secs = 5, 7
    assert read(reader, marker(1)) == [(2.0, 1, 1.0)]
    assert read(reader, again) == []
    assert read(reader, marker(1, x=3.0)) == [(2.0, 1, 3.0)]


def test_each_marker_of_an_array_is_read():
    array = MarkerArray(markers=[marker(1), marker(2, x=4.0)])
    assert read(MarkerReader(), array) == [(2.0, 1, 1.0), (2.0, 2, 4.0)]
