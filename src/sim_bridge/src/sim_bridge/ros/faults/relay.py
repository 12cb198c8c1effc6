"""The node ``fault_relay``: injects faults into messages between external nodes."""

import threading
from pathlib import Path
from typing import Any, NamedTuple, Optional, Type, Union

import rospy
from geometry_msgs.msg import Transform, TransformStamped, Vector3
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

from planar import PlanarError, SettingsError
from planar_ros.messages.conversion import frame_name
from planar_ros.messages.validation import WARN_SECONDS, MessageError, is_stamp, subscribe
from planar_ros.node.parameters import read_settings
from planar_ros.node.runner import run
from planar_ros.node.topics import remap_once
from rospy_transport.node import sleep_until
from sim_bridge.config import RelaySettings
from sim_bridge.faults import load_faults
from sim_bridge.faults.injection import apply_faults
from sim_bridge.faults.relay import RelayedFaults, unsupported_by_relay
from sim_bridge.ros.faults.raw import RawMessage, raw_type
from sim_bridge.ros.faults.received import ReceivedCommand, ReceivedOdometry, ReceivedScan
from sim_bridge.ros.faults.service import advertise_add_fault
from sim_bridge.ros.messages import pose3_from_msg, pose3_to_msg

QUEUE_SIZE = 100
# Suffix of the topic on which faulty messages are published.
FAULTY = "_faulty"


class RelayedTopic(NamedTuple):
    """A topic that is relayed to the topic of its name with the suffix FAULTY.

    Attributes:
        topic: Name of the subscribed topic.
        method: Method of a fault that changes its messages.
        value_type: Type of the method's argument.
    """

    topic: str
    method: str
    value_type: Type[Union[ReceivedScan, ReceivedOdometry, ReceivedCommand]]


ODOMETRY = RelayedTopic("odom", "odometry", ReceivedOdometry)
RELAYED_TOPICS = (
    RelayedTopic("scan", "scan", ReceivedScan),
    ODOMETRY,
    RelayedTopic("cmd_vel", "command", ReceivedCommand),
)


class FaultRelay:
    """Subscribes to scans, odometry and commands, and publishes what the faults make of them."""

    def __init__(self):
        settings = read_settings(RelaySettings)
        file = settings.faults_file
        faults = load_faults(Path(file), unsupported_by_relay) if file else ()
        self._faults = RelayedFaults(faults, settings.seed)
        self._lock = threading.Lock()  # each topic and each service has its own thread
        self._tf: Optional[rospy.Publisher] = None
        if settings.publish_tf:
            self._tf = rospy.Publisher("/tf", TFMessage, queue_size=QUEUE_SIZE, tcp_nodelay=True)
        topics = [relayed.topic for relayed in RELAYED_TOPICS]
        names = remap_once(*topics, *(topic + FAULTY for topic in topics))
        inputs, outputs = names[: len(topics)], names[len(topics) :]
        for relayed, input_name, output_name in zip(RELAYED_TOPICS, inputs, outputs):
            if output_name in inputs:
                raise SettingsError(
                    f"{relayed.topic}{FAULTY} is remapped to {output_name}, to which the relay subscribes; "
                    "remap one of them to another name"
                )
            self._relay(relayed, input_name, output_name)
        first = sleep_until(rospy.Time(0)).to_sec()
        with self._lock:
            self._faults.begin(first)
        advertise_add_fault(self._add)

    def _relay(self, relayed: RelayedTopic, input_name: str, output_name: str) -> None:
        kind = raw_type(relayed.value_type.kind)
        publisher = rospy.Publisher(output_name, kind, queue_size=QUEUE_SIZE, tcp_nodelay=True)

        def on_message(message: RawMessage) -> None:
            with self._lock:
                faulty = self._apply(message, relayed)
                if faulty is not None:
                    publisher.publish(faulty)
                    if relayed is ODOMETRY and self._tf is not None:
                        self._send_transform(self._tf, faulty)

        subscribe(input_name, kind, on_message, queue_size=QUEUE_SIZE, tcp_nodelay=True)

    def _apply(self, message: RawMessage, relayed: RelayedTopic) -> Optional[RawMessage]:
        """Return the message to publish; None for none. Raises PlanarError for an invalid message."""
        kinds = self._faults.active(rospy.get_time(), relayed.method)
        if not kinds:
            return message
        received: Any = relayed.value_type.from_msg(message.decode())
        changed = apply_faults(kinds, relayed.method, received)
        return None if changed is None else type(message).from_message(received.to_msg(changed))

    @staticmethod
    def _send_transform(tf: rospy.Publisher, odometry: RawMessage) -> None:
        try:
            tf.publish(TFMessage([transform_of(odometry.decode())]))
        except PlanarError as error:
            rospy.logwarn_throttle_identical(WARN_SECONDS, f"no transform of odometry: {error}")

    def _add(self, kind: str, seconds: float, strength: float) -> None:
        with self._lock:
            self._faults.add(kind, seconds, strength, rospy.get_time())


def transform_of(odometry: Odometry) -> TransformStamped:
    """Return the transform of an odometry message.

    Raises:
        PlanarError: The message is invalid.
    """
    parent, child = frame_name(odometry.header.frame_id), frame_name(odometry.child_frame_id)
    if not (parent and child and is_stamp(odometry.header.stamp)):
        raise MessageError("a frame is missing, or the stamp is invalid")
    pose = pose3_to_msg(pose3_from_msg(odometry.pose.pose))
    transform = TransformStamped(child_frame_id=child)
    transform.header.stamp, transform.header.frame_id = odometry.header.stamp, parent
    position = pose.position
    transform.transform = Transform(Vector3(position.x, position.y, position.z), pose.orientation)
    return transform


def main():
    run("fault_relay", FaultRelay)
