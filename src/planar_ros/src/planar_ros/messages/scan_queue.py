"""Queue of scans that wait for their transforms."""

import threading
import traceback
from typing import Callable, Dict

import rospy
from tf2_msgs.msg import TFMessage

from planar import PlanarError, Pose2, Scan
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.conversion import LaserScanArrays, frame_name, scan_from_msg
from planar_ros.messages.transforms import JUMP_BACK_SECONDS, Transforms


class ScanQueue:
    """Passes on each scan as soon as odometry at its stamp is known.

    Transforms may arrive shortly before or after their scan. Scans are processed in a separate thread, or at
    logical instants in lock-step, so that waiting blocks nothing else.

    Args:
        transforms: Source of odometry and of the lasers' mounting poses.
        odom_frame: Frame of odometry.
        base_frame: Frame of the robot's base.
        handle: Called with message, scan and odometry (pose of the base in ``odom_frame``), in order for
            each laser.
        skip: Called with the message and a reason for people, for a scan whose odometry can no longer become
            known or that ``size`` newer scans have overtaken.
        topic: Topic of the scans (sensor_msgs/LaserScan).
        size: Most scans that may wait.

    Attributes:
        topic: Resolved topic name.
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
        self._newest_stamp = rospy.Time(0)
        self._condition = threading.Condition()
        self._wake_count = 0
        self._step = LockstepClient.of_node()
        self._step.on_instant(self._process_waiting)
        rospy.on_shutdown(self._wake)
        threading.Thread(target=self._work, daemon=True).start()
        # Subscribed after the tf listener, whose callback has then already added the same message.
        rospy.Subscriber("/tf", TFMessage, self._on_transforms, tcp_nodelay=True)
        rospy.Subscriber("/tf_static", TFMessage, self._on_transforms)
        self._scans = rospy.Subscriber(topic, LaserScanArrays, self.add, queue_size=size, tcp_nodelay=True)

    @property
    def has_received(self) -> bool:
        """Whether any scan has been received."""
        return self._received > 0

    @property
    def waiting(self) -> int:
        """Number of scans that wait for transforms."""
        return len(self._waiting)

    def set_frames(self, odom_frame: str, base_frame: str) -> None:
        """Change the frames of odometry and of the base."""
        with self._condition:
            self._odom_frame, self._base_frame = odom_frame, base_frame

    def add(self, message) -> None:
        """Add a scan; waiting scans and transforms are cleared if its stamp has jumped back."""
        with self._condition:
            if message.header.stamp.to_sec() < self._newest_stamp.to_sec() - JUMP_BACK_SECONDS:
                rospy.logwarn("time has jumped back: clearing waiting scans and transforms")
                self._waiting.clear()
                self._transforms.clear()
                self._newest_stamp = message.header.stamp
            self._newest_stamp = max(self._newest_stamp, message.header.stamp)
            self._received += 1
            self._waiting[self._received] = message
        self._wake()

    def unsubscribe(self) -> None:
        """Stop receiving scans from the topic, so that only those given to ``add`` are processed."""
        self._scans.unregister()

    def finish(self) -> None:
        """Process the waiting scans without waiting for more transforms; skip those without odometry."""
        self._is_ending = True
        self._wake()

    def _on_transforms(self, message):
        if self._waiting:
            self._wake()

    def _wake(self):
        if self._step.is_synchronized and not self._is_ending:
            return  # the next logical instant processes them
        with self._condition:
            self._wake_count += 1
            self._condition.notify_all()

    def _work(self):
        seen = 0
        while not rospy.is_shutdown():
            with self._condition:
                self._condition.wait_for(lambda: self._wake_count != seen or rospy.is_shutdown())  # noqa: B023
                seen = self._wake_count
            if not self._step.is_synchronized:
                self._process_waiting()

    def _process_waiting(self):
        with self._condition:
            waiting = list(self._waiting.items())
        for number, message in waiting:
            is_late = self._is_ending or self._received - number >= self.size
            if self._try_process(message, is_late):
                with self._condition:
                    self._waiting.pop(number, None)

    def _try_process(self, message, is_late):
        try:
            return self._process(message, is_late)
        except Exception:  # as in rospy: an exception in a callback must not end the thread
            rospy.logerr("bad callback: %s", traceback.format_exc())
            return True

    def _process(self, message, is_late):
        """Handle or skip a scan; return False if it has to wait."""
        stamp, frame = message.header.stamp, frame_name(message.header.frame_id)
        base_in_odom = self._transforms.lookup(self._odom_frame, self._base_frame, stamp)
        mounting = self._transforms.mounting(self._base_frame, frame, stamp)
        if base_in_odom is not None and mounting is not None:
            try:
                self._handle(message, scan_from_msg(message, *mounting), base_in_odom)
            except PlanarError as error:
                self._skip(message, str(error))
            return True
        for known, parent, child in (
            (base_in_odom, self._odom_frame, self._base_frame),
            (mounting, self._base_frame, frame),
        ):
            if known is None and self._is_past(parent, child, stamp):
                self._skip(message, f"{parent} -> {child} is not known for its stamp")
                return True
        if is_late:
            missing = self._odom_frame if base_in_odom is None else frame
            self._skip(message, f"no transform between {missing} and {self._base_frame} came in time")
            return True
        return False

    def _is_past(self, parent, child, stamp):
        """Whether newer transforms are known, so that the one at ``stamp`` will not arrive any more."""
        latest = self._transforms.latest_stamp(parent, child)
        return latest is not None and latest > stamp
