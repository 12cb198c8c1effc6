"""The node ``fault_relay``: puts faults between nodes that are not ours."""

import threading
from pathlib import Path
from typing import Any, NamedTuple, Optional, Type, Union

import rospy
from geometry_msgs.msg import Transform, TransformStamped, Vector3
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

from planar import PlanarError, SettingsError
from planar_ros.messages.border import WARN_SECONDS, MessageError, is_stamp, subscribe
from planar_ros.messages.conversion import frame_name
from planar_ros.node.clock import sleep_until
from planar_ros.node.parameters import read_settings
from planar_ros.node.remapping import remap_once
from planar_ros.node.shell import run
from sim_bridge.config import RelaySettings
from sim_bridge.faults import load_faults
from sim_bridge.faults.faulty import through
from sim_bridge.faults.relayed import RelayedFaults, why_not_relayed
from sim_bridge.ros.faults.asking import offer_faults
from sim_bridge.ros.faults.heard import HeardCommand, HeardOdometry, HeardScan
from sim_bridge.ros.faults.raw import RawMessage, raw
from sim_bridge.ros.messages import pose3_from_msg, pose3_to_msg

QUEUE_SIZE = 100


class Way(NamedTuple):
    """Of the messages on a topic; what faults make of them is told on another, ``topic`` with FAULTY behind.

    ``change``: the method of a kind of fault that does so; ``heard``: what it is given.
    """

    topic: str
    change: str
    heard: Type[Union[HeardScan, HeardOdometry, HeardCommand]]


FAULTY = "_faulty"
ODOMETRY = Way("odom", "odometry", HeardOdometry)
WAYS = (Way("scan", "scan", HeardScan), ODOMETRY, Way("cmd_vel", "command", HeardCommand))


class FaultRelay:
    """Hears scans, odometry and commands, and publishes what the faults make of them; all else as it came."""

    def __init__(self):
        settings = read_settings(RelaySettings)
        file = settings.faults_file
        self._faults = RelayedFaults(load_faults(Path(file), why_not_relayed) if file else (), settings.seed)
        self._lock = threading.Lock()  # each topic and each service has a thread of its own
        self._tf: Optional[rospy.Publisher] = None
        if settings.publish_tf:
            self._tf = rospy.Publisher("/tf", TFMessage, queue_size=QUEUE_SIZE, tcp_nodelay=True)
        topics = [way.topic for way in WAYS]
        names = remap_once(*topics, *(topic + FAULTY for topic in topics))
        for way, hear_on, tell_on in zip(WAYS, names, names[len(WAYS) :]):
            if tell_on in names[: len(WAYS)]:
                raise SettingsError(
                    f"{way.topic}{FAULTY} is remapped to {tell_on}, which the relay itself hears"
                )
            self._relay(way, hear_on, tell_on)
        first = sleep_until(rospy.Time(0)).to_sec()
        with self._lock:
            self._faults.begin(first)
        offer_faults(self._add)

    def _relay(self, way: Way, hear_on: str, tell_on: str) -> None:
        kind = raw(way.heard.kind)
        publisher = rospy.Publisher(tell_on, kind, queue_size=QUEUE_SIZE, tcp_nodelay=True)

        def hand_on(message: RawMessage) -> None:
            with self._lock:
                told = self._told(message, way)
                if told is not None:
                    publisher.publish(told)
                    if way is ODOMETRY and self._tf is not None:
                        self._send_transform(self._tf, told)

        subscribe(hear_on, kind, hand_on, queue_size=QUEUE_SIZE, tcp_nodelay=True)

    def _told(self, message: RawMessage, way: Way) -> Optional[RawMessage]:
        """What is told instead of a message; None: nothing. Raises PlanarError for one without meaning."""
        kinds = self._faults.at(rospy.get_time(), way.change)
        if not kinds:
            return message
        heard: Any = way.heard.of(message.read())
        told = through(kinds, way.change, heard)
        return None if told is None else type(message).of(heard.tell(told))

    @staticmethod
    def _send_transform(tf: rospy.Publisher, odometry: RawMessage) -> None:
        try:
            tf.publish(TFMessage([transform_of(odometry.read())]))
        except PlanarError as error:
            rospy.logwarn_throttle_identical(WARN_SECONDS, f"no transform of odometry: {error}")

    def _add(self, kind: str, seconds: float, strength: float) -> None:
        with self._lock:
            self._faults.add(kind, seconds, strength, rospy.get_time())


def transform_of(odometry: Odometry) -> TransformStamped:
    """Where odometry tells that the base is. Raises PlanarError if that is nowhere."""
    parent, child = frame_name(odometry.header.frame_id), frame_name(odometry.child_frame_id)
    if not (parent and child and is_stamp(odometry.header.stamp)):
        raise MessageError("it lacks a frame, or its stamp is none")
    pose = pose3_to_msg(pose3_from_msg(odometry.pose.pose))
    made = TransformStamped(child_frame_id=child)
    made.header.stamp, made.header.frame_id = odometry.header.stamp, parent
    at = pose.position
    made.transform = Transform(Vector3(at.x, at.y, at.z), pose.orientation)
    return made


def main():
    run("fault_relay", FaultRelay)
