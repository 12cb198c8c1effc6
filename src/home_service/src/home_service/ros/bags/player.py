"""Node ``bag_player``: plays sensor data in lock-step with the nodes that process it.

Transforms below the map, which were estimated during the recording, are left out, so that they can be
estimated again.
"""

import itertools
import threading
import time
from typing import Iterable, Iterator, Optional, Set

import rospy
from rosgraph_msgs.msg import Clock
from roslib.message import get_message_class
from std_msgs.msg import Header, String
from tf2_msgs.msg import TFMessage

from home_service.ros.bags import BROKEN, ENDED, PLAYING, bags_of
from planar import Pose2
from planar_ros.bags.bag_reader import LASER_SCAN, TF_STATIC, BagError, RecordedMessage
from planar_ros.bags.recording import Recording
from planar_ros.lockstep.ticker import PROGRESS_TOPIC
from planar_ros.messages.conversion import frame_name, time_of, transform_msg
from planar_ros.node.runner import run
from sim_bridge.pacing import Pacer

SUBSCRIBER_TIMEOUT = 30.0
CLOCK_SECONDS = 0.01
# Time by which nodes may be behind the bag's time, which is that of reception, not the stamp [s].
AHEAD_SECONDS = 0.5
FIRST_SCAN_SECONDS = 0.3
INPUT_TYPES = {LASER_SCAN, "sensor_msgs/PointCloud2", "nav_msgs/Odometry", "tf2_msgs/TFMessage"}
MAP_FRAME = "map"


class BagPlayer:
    """Publishes the messages and the clock of a recording; ``~state`` reports its end."""

    def __init__(self):
        self._recording = Recording(bags_of(rospy.get_param("~bags")))
        speed, wait_for = float(rospy.get_param("~speed", 1.0)), rospy.get_param("~wait_for", "").split()
        self._pacer = Pacer(speed, wait_for, shortest_period=AHEAD_SECONDS)
        self._changed = threading.Condition()
        self._state = rospy.Publisher("~state", String, queue_size=10, latch=True)
        self._clock = rospy.Publisher("/clock", Clock, queue_size=10, tcp_nodelay=True)
        self._clock_stamp = 0.0
        self._is_estimate_missing = bool(wait_for)
        rospy.Subscriber("/tf", TFMessage, self._on_tf, queue_size=100)
        rospy.Subscriber(PROGRESS_TOPIC, Header, self._on_progress, queue_size=50, tcp_nodelay=True)
        types = self._recording.types
        self._topics: Set[str] = {topic for topic, kind in types.items() if kind in INPUT_TYPES}
        self._topics -= self._recording.unavailable_topics
        if LASER_SCAN not in types.values():
            topics = ", ".join(sorted(types)) or "none"
            raise BagError(f"{self._recording.paths[0]}: no laser scans; topics: {topics}")
        self._assumed = [pair.split(">") for pair in rospy.get_param("~assumed", "").split()]
        self._scans = [topic for topic in self._topics if types[topic] == LASER_SCAN]
        self._publishers = {
            topic: rospy.Publisher(
                topic,
                get_message_class(types[topic]),
                queue_size=100,
                latch=topic == TF_STATIC,
                tcp_nodelay=True,
            )
            for topic in self._topics
        }

    def work(self) -> None:
        """Play everything; latched topics stay published afterwards."""
        self._state.publish(PLAYING)
        self._publish_static()
        self._wait_for_subscribers()
        messages = self._recording.messages(self._topics - {TF_STATIC})
        try:
            self._play(itertools.chain(self._until_first_estimate(messages), messages))
        except BagError as error:
            self._state.publish(BROKEN + str(error))
            return
        self._wait_until_due(self._recording.end + 2.0 * CLOCK_SECONDS)
        self._state.publish("; ".join([ENDED, *self._recording.truncations]))

    def _play(self, messages: Iterable[RecordedMessage]) -> None:
        for topic, message, stamp in messages:
            if rospy.is_shutdown():
                return
            self._wait_until_due(stamp)
            self._publish_clock(stamp)
            self._publish(topic, message)

    def _until_first_estimate(self, messages: Iterator[RecordedMessage]) -> Iterator[RecordedMessage]:
        """Yield the messages until shortly after the first scan, and wait until a node has used that scan.

        A node that is not ready yet would otherwise start in the middle, while the robot drives.
        """
        first: Optional[RecordedMessage] = None
        for played in messages:
            yield played
            if first is None and played.topic in self._scans:
                first = played
            if first is not None and played.stamp > first.stamp + FIRST_SCAN_SECONDS:
                break
        deadline = time.monotonic() + SUBSCRIBER_TIMEOUT
        while first is not None and self._is_estimate_missing and time.monotonic() < deadline:
            if rospy.is_shutdown():
                return
            self._publish(first.topic, first.message)
            time.sleep(FIRST_SCAN_SECONDS)

    def _publish(self, topic: str, message) -> None:
        if topic == "/tf":
            message.transforms = [
                transform
                for transform in message.transforms
                if frame_name(transform.header.frame_id) != MAP_FRAME
            ]
            if not message.transforms:
                return
        self._publishers[topic].publish(message)

    def _publish_static(self) -> None:
        """Publish all static transforms at once: a latched topic keeps only its last message."""
        if not self._assumed and TF_STATIC not in self._publishers:
            return
        together = {
            transform.child_frame_id: transform
            for played in self._recording.messages({TF_STATIC})
            for transform in played.message.transforms
        }
        assumed = [
            transform_msg(Pose2(), parent, child, time_of(self._recording.start))
            for parent, child in self._assumed
        ]
        publisher = self._publishers.setdefault(
            TF_STATIC, rospy.Publisher(TF_STATIC, TFMessage, queue_size=100, latch=True)
        )
        publisher.publish(TFMessage([*together.values(), *assumed]))

    def _wait_for_subscribers(self) -> None:
        """Wait until a node subscribes to the scans, or for half a minute."""
        scans = [self._publishers[topic] for topic in self._scans]
        deadline = time.monotonic() + SUBSCRIBER_TIMEOUT
        while time.monotonic() < deadline and not rospy.is_shutdown():
            self._publish_clock(self._recording.start)
            if any(publisher.get_num_connections() > 0 for publisher in scans):
                return
            time.sleep(5.0 * CLOCK_SECONDS)

    def _wait_until_due(self, stamp: float) -> None:
        while not rospy.is_shutdown():
            with self._changed:
                delay = self._pacer.delay(stamp, time.monotonic())
                if delay <= 0.0:
                    return
                self._changed.wait(delay)
                for node in self._pacer.give_up(stamp, time.monotonic()):
                    rospy.logwarn("%s does not keep up: not waited for until it reports progress again", node)

    def _publish_clock(self, stamp: float) -> None:
        if stamp >= self._clock_stamp + CLOCK_SECONDS or self._clock_stamp == 0.0:
            self._clock_stamp = stamp
        self._clock.publish(Clock(time_of(self._clock_stamp)))

    def _on_tf(self, message) -> None:
        if any(frame_name(transform.header.frame_id) == MAP_FRAME for transform in message.transforms):
            self._is_estimate_missing = False

    def _on_progress(self, message) -> None:
        with self._changed:
            self._pacer.report(message.frame_id, message.stamp.to_sec())
            self._changed.notify_all()


def main():
    run("bag_player", lambda: BagPlayer().work())
