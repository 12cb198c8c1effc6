"""Scans that wait for their transforms."""

import threading
import traceback
from typing import Callable, Dict, Tuple

import rospy
from tf2_msgs.msg import TFMessage

from planar import PlanarError, Pose2, Scan
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.conversion import LaserScanArrays, frame_name, scan_from_msg
from planar_ros.messages.transforms import JUMP_BACK_SECONDS, Transforms


class ScanQueue:
    """Hands on each scan once it is known where the robot was, in odometry, at the scan's stamp.

    A transform may come a little before or after its scan; the waiting holds up nothing else, it happens in a
    thread of its own, in step at moments. ``handle(message, scan, base_in_odom)`` is called there, scans of
    one laser in order; ``skip(message, reason)`` for each scan whose odometry will never be known, or that
    ``size`` others have overtaken. Reasons are for people.
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
        self.size = size
        self._transforms, self._odom_frame, self._base_frame = transforms, odom_frame, base_frame
        self._handle, self._skip = handle, skip
        self._waiting: Dict[int, LaserScanArrays] = {}
        self._received = 0
        self._is_ending = False
        self._mountings: Dict[str, Tuple[Pose2, bool]] = {}
        self._newest_stamp = rospy.Time(0)
        self._has_news = threading.Condition()
        self._news = 0
        self._step = LockstepClient.of_node()
        self._step.on_instant(self._deal_with_waiting)
        rospy.on_shutdown(self._wake)
        threading.Thread(target=self._work, daemon=True).start()
        # Subscribed to after the listener, whose callback has then already taken in the same message.
        rospy.Subscriber("/tf", TFMessage, self._on_transforms, tcp_nodelay=True)
        rospy.Subscriber("/tf_static", TFMessage, self._on_transforms)
        self._heard = rospy.Subscriber(topic, LaserScanArrays, self.add, queue_size=size, tcp_nodelay=True)

    @property
    def has_received(self) -> bool:
        """Whether any scan has come yet."""
        return self._received > 0

    @property
    def waiting(self) -> int:
        """How many scans have not been dealt with yet."""
        return len(self._waiting)

    def set_frames(self, odom_frame: str, base_frame: str) -> None:
        """From now on asks for transforms between these frames."""
        with self._has_news:
            self._odom_frame, self._base_frame = odom_frame, base_frame
            self._mountings.clear()

    def add(self, message) -> None:
        """Takes in a scan, as one that comes by topic."""
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

    def unsubscribe(self) -> None:
        """Only what is given to ``take`` counts; it may be published on the topic and does not come again."""
        self._heard.unregister()

    def finish(self) -> None:
        """Nothing more will come: what cannot be handed on now is skipped."""
        self._is_ending = True
        self._wake()

    def _on_transforms(self, message):
        if self._waiting:
            self._wake()

    def _wake(self):
        if self._step.is_synchronized and not self._is_ending:
            return  # the moment has it looked after
        with self._has_news:
            self._news += 1
            self._has_news.notify_all()

    def _work(self):
        seen = 0
        while not rospy.is_shutdown():
            with self._has_news:
                self._has_news.wait_for(lambda: self._news != seen or rospy.is_shutdown())  # noqa: B023
                seen = self._news
            if not self._step.is_synchronized:
                self._deal_with_waiting()

    def _deal_with_waiting(self):
        with self._has_news:
            waiting = list(self._waiting.items())
        for number, message in waiting:
            is_late = self._is_ending or self._received - number >= self.size
            if self._is_done_with(message, is_late):
                with self._has_news:
                    self._waiting.pop(number, None)

    def _is_done_with(self, message, is_late):
        try:
            return self._deal_with(message, is_late)
        except Exception:  # as rospy does with its callbacks: a fault must not silence the node for good
            rospy.logerr("bad callback: %s", traceback.format_exc())
            return True

    def _deal_with(self, message, is_late):
        """Hands on or skips a scan; False if it must wait on."""
        stamp, frame = message.header.stamp, frame_name(message.header.frame_id)
        base_in_odom = self._transforms.lookup(self._odom_frame, self._base_frame, stamp)
        mounting = self._mountings.get(frame) or self._transforms.mounting(self._base_frame, frame)
        if base_in_odom is not None and mounting is not None:
            self._mountings[frame] = mounting
            try:
                self._handle(message, scan_from_msg(message, *mounting), base_in_odom)
            except PlanarError as error:
                self._skip(message, str(error))
            return True
        latest = self._transforms.latest_stamp(self._odom_frame, self._base_frame)
        if base_in_odom is None and latest is not None and latest > stamp:
            self._skip(message, f"{self._odom_frame} -> {self._base_frame} is not known for its stamp")
            return True
        if is_late:
            known = self._odom_frame if base_in_odom is None else frame
            self._skip(message, f"no transform between {known} and {self._base_frame} came in time")
            return True
        return False
