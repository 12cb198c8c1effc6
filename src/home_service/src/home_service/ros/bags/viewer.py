"""Node ``bag_viewer``: plays a whole recording from any position at any speed."""

import math
import threading
import time
from typing import Iterable

import rospy
from home_service_msgs.msg import Playback
from home_service_msgs.srv import Seek, SetPlaybackSpeed
from rosgraph_msgs.msg import Clock
from roslib.message import get_message_class
from std_msgs.msg import String
from std_srvs.srv import SetBool
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from home_service.ros.bags import BROKEN, ENDED, PLAYING, bags_of
from planar_ros.bags.bag_reader import TF_STATIC, BagError, RecordedMessage
from planar_ros.bags.frames import read_tree
from planar_ros.bags.playback_clock import PlaybackClock
from planar_ros.bags.recording import Recording
from planar_ros.bags.snapshot import MARKERS, snapshot_at
from planar_ros.messages.conversion import time_of
from planar_ros.node.runner import run

# The running rosout aggregates replayed log messages again; after a seek, old log messages are not repeated.
ROSOUT, ROSOUT_AGG = "/rosout", "/rosout_agg"
CLOCK_SECONDS, PLAYBACK_SECONDS, POLL_SECONDS = 0.01, 0.2, 0.1
# Time for viewers to notice that the clock has jumped, and to reset their displays [s].
RESET_SECONDS = 0.3


class BagViewer:
    """Publishes all messages and the clock of a recording; ``~state`` reports its end.

    With ``~stays`` the node keeps running at the end, so that one can seek back.
    """

    def __init__(self):
        self._recording = Recording(bags_of(rospy.get_param("~bags")))
        self._stays = bool(rospy.get_param("~stays", False))
        speed = float(rospy.get_param("~speed", 1.0))
        self._head = PlaybackClock(self._recording.start, self._recording.end, speed, time.monotonic())
        self._changed = threading.Condition()
        self._seek_count = 0
        self._state = rospy.Publisher("~state", String, queue_size=10, latch=True)
        self._playback = rospy.Publisher("~playback", Playback, queue_size=1, latch=True)
        self._playback_stamp = -math.inf
        self._clock = rospy.Publisher("/clock", Clock, queue_size=10, tcp_nodelay=True)
        self._clock_stamp = -math.inf
        types, foreign = self._recording.types, self._recording.unavailable_topics
        for topic in foreign:
            rospy.logwarn("%s is left out: the installed %s is not the recorded one", topic, types[topic])
        self._topics = set(types) - foreign - {"/clock", TF_STATIC, ROSOUT_AGG}
        # Latched, so that late subscribers receive the current messages while the playback is paused.
        self._publishers = {
            topic: rospy.Publisher(
                topic, get_message_class(types[topic]), queue_size=100, latch=True, tcp_nodelay=True
            )
            for topic in self._topics
        }
        self._static = rospy.Publisher(TF_STATIC, TFMessage, queue_size=1, latch=True)
        rospy.Service("~pause_playback", SetBool, self._pause)  # as of rosbag play
        rospy.Service("~seek", Seek, self._seek)
        rospy.Service("~set_speed", SetPlaybackSpeed, self._set_speed)

    def work(self) -> None:
        """Play to the end; latched topics stay published afterwards."""
        static = read_tree(self._recording, [TF_STATIC]).first.values()
        self._static.publish(TFMessage(list(static)))
        self._state.publish(PLAYING)
        try:
            while not rospy.is_shutdown():
                if self._play_on():
                    self._state.publish("; ".join([ENDED, *self._recording.truncations]))
                    if not self._stays:
                        return
                    self._wait_for_seek()
                    self._state.publish(PLAYING)
        except BagError as error:
            self._state.publish(BROKEN + str(error))

    def _play_on(self) -> bool:
        """Play from the playhead; return whether the end was reached."""
        with self._changed:
            jump, start = self._seek_count, self._head.position
        if jump:
            self._clear_markers()
        self._publish_clock(start)
        if jump:
            time.sleep(RESET_SECONDS)
        self._publish(snapshot_at(self._recording, self._topics - {ROSOUT}, start))
        for played in self._recording.messages(self._topics, since=start):
            if not self._wait_until_due(played.stamp, jump):
                return False
            self._publish_clock(played.stamp)
            self._publish((played,))
        return self._wait_until_due(self._recording.end + 2.0 * CLOCK_SECONDS, jump)

    def _wait_until_due(self, stamp: float, jump: int) -> bool:
        """Wait until a stamp is due; return False if the playhead was moved, or at shutdown."""
        while not rospy.is_shutdown():
            with self._changed:
                if self._seek_count != jump:
                    return False
                wall = time.monotonic()
                delay = self._head.delay(stamp, wall)
                self._publish_playback(wall)
                if delay <= 0.0:
                    self._head.advance_to(min(stamp, self._recording.end))
                    return True
                self._changed.wait(min(delay, POLL_SECONDS))
        return False

    def _wait_for_seek(self) -> None:
        with self._changed:
            jump = self._seek_count
            while self._seek_count == jump and not rospy.is_shutdown():
                self._publish_playback(time.monotonic())
                self._changed.wait(POLL_SECONDS)

    def _publish(self, messages: Iterable[RecordedMessage]) -> None:
        for played in messages:
            self._publishers[played.topic].publish(played.message)

    def _clear_markers(self) -> None:
        """Delete the markers of another time."""
        every = Marker(action=Marker.DELETEALL)
        for topic in set(self._recording.topics_of(*MARKERS)) & self._topics:
            is_one = self._recording.types[topic] == MARKERS[0]
            self._publishers[topic].publish(every if is_one else MarkerArray([every]))

    def _publish_clock(self, stamp: float) -> None:
        if not 0.0 <= stamp - self._clock_stamp < CLOCK_SECONDS:
            self._clock_stamp = stamp
            self._clock.publish(Clock(time_of(stamp)))

    def _publish_playback(self, wall: float) -> None:
        if wall >= self._playback_stamp + PLAYBACK_SECONDS:
            self._playback_stamp, head = wall, self._head
            length, position = head.end - head.start, head.position - head.start
            self._playback.publish(Playback(length, position, head.speed, head.is_paused))

    def _pause(self, request):
        with self._changed:
            self._head.pause(request.data, time.monotonic())
            return True, self._changed_now()

    def _seek(self, request):
        if not math.isfinite(request.position):
            return False, f"{request.position} is no position: expected a finite number of seconds"
        with self._changed:
            self._seek_count += 1
            self._head.seek(request.position, time.monotonic())
            return True, self._changed_now()

    def _set_speed(self, request):
        if not 0.0 <= request.speed < math.inf:
            return False, f"{request.speed} is no speed: expected a finite number of at least 0"
        with self._changed:
            self._head.set_speed(request.speed, time.monotonic())
            return True, self._changed_now()

    def _changed_now(self) -> str:
        self._playback_stamp = -math.inf
        self._changed.notify_all()
        return ""


def main():
    run("bag_viewer", lambda: BagViewer().work())
