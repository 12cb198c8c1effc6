"""Scans that wait for their transforms."""

import threading
import traceback
from typing import Callable, Dict, Tuple

import rospy
from tf2_msgs.msg import TFMessage

from planar import Pose2, Scan
from planar_ros.messages import LaserScanArrays, frame_name, scan_from_msg
from planar_ros.transforms import Transforms

# A stamp this much older than the one before it means that time has jumped back: a bag's loop, a reset.
JUMP_BACK_SECONDS = 1.0


class ScanQueue:
    """Hands on each scan once it is known where the robot was, in odometry, at the scan's stamp.

    A transform may come a little before or after its scan; the waiting holds up nothing else, it happens in a
    thread of its own. ``handle(message, scan, base_in_odom)`` is called there, scans of one laser in order;
    ``skip(message, reason)`` for each scan whose odometry will never be known, or that ``size`` others have
    overtaken. Reasons are for people.
    """

    def __init__(
        self,
        transforms: Transforms,
        odom_frame: str,
        base_frame: str,
        handle: Callable[[LaserScanArrays, Scan, Pose2], None],
        skip: Callable[[LaserScanArrays, str], None],
        topic: str = "scan",
        size: int = 100,
    ):
        self.topic = rospy.resolve_name(topic)
        self._transforms, self._odom_frame, self._base_frame = transforms, odom_frame, base_frame
        self._handle, self._skip = handle, skip
        self._waiting: Dict[int, LaserScanArrays] = {}
        self._received = 0
        self._size = size
        self._mountings: Dict[str, Tuple[Pose2, bool]] = {}
        self._newest_stamp = rospy.Time(0)
        self._has_news = threading.Condition()
        self._news = 0
        rospy.on_shutdown(self._wake)
        threading.Thread(target=self._work, daemon=True).start()
        # Subscribed to after the listener, whose callback has then already taken in the same message.
        rospy.Subscriber("/tf", TFMessage, lambda message: self._wake(), tcp_nodelay=True)
        rospy.Subscriber("/tf_static", TFMessage, lambda message: self._wake())
        rospy.Subscriber(topic, LaserScanArrays, self._receive, queue_size=size, tcp_nodelay=True)

    def _receive(self, message):
        with self._has_news:
            if message.header.stamp.to_sec() < self._newest_stamp.to_sec() - JUMP_BACK_SECONDS:
                rospy.logwarn("time has jumped back: forgetting waiting scans and transforms")
                self._waiting.clear()
                self._transforms.clear()
                self._newest_stamp = message.header.stamp
            self._newest_stamp = max(self._newest_stamp, message.header.stamp)
            self._received += 1
            self._waiting[self._received] = message
        self._wake()

    def _wake(self):
        with self._has_news:
            self._news += 1
            self._has_news.notify_all()

    def _work(self):
        seen = 0
        while not rospy.is_shutdown():
            with self._has_news:
                self._has_news.wait_for(lambda: self._news != seen or rospy.is_shutdown())  # noqa: B023
                seen = self._news
                waiting = list(self._waiting.items())
            for number, message in waiting:
                if self._is_done_with(message, is_overtaken=self._received - number >= self._size):
                    with self._has_news:
                        self._waiting.pop(number, None)

    def _is_done_with(self, message, is_overtaken):
        try:
            return self._deal_with(message, is_overtaken)
        except Exception:  # as rospy does with its callbacks: a fault must not silence the node for good
            rospy.logerr("bad callback: %s", traceback.format_exc())
            return True

    def _deal_with(self, message, is_overtaken):
        """Hands on or skips a scan; False if it must wait on."""
        stamp, frame = message.header.stamp, frame_name(message.header.frame_id)
        latest = self._transforms.latest_stamp(self._odom_frame, self._base_frame)
        base_in_odom = self._transforms.lookup(self._odom_frame, self._base_frame, stamp)
        mounting = self._mountings.get(frame) or self._transforms.mounting(self._base_frame, frame)
        if base_in_odom is not None and mounting is not None:
            self._mountings[frame] = mounting
            self._handle(message, scan_from_msg(message, *mounting), base_in_odom)
            return True
        if base_in_odom is None and latest is not None and latest > stamp:
            self._skip(message, f"{self._odom_frame} -> {self._base_frame} is not known for its stamp")
            return True
        if is_overtaken:
            missing = (
                (self._odom_frame, self._base_frame) if base_in_odom is None else (self._base_frame, frame)
            )
            self._skip(message, "no transform {} -> {} came in time".format(*missing))
            return True
        return False
