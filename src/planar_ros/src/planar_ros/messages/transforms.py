"""Transforms between frames as poses in the plane."""

import math
import threading
from typing import Dict, Iterable, Optional, Tuple

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped

from planar import Pose2
from planar_ros.messages.conversion import frame_name, pose2_of, transform_msg
from planar_ros.messages.validation import WARN_SECONDS, MessageError, is_stamp

# Time has jumped back (a looped bag, a reset) if a stamp is older than the one before by this much [s].
JUMP_BACK_SECONDS = 1.0

# Time that stands for the latest transform.
LATEST = rospy.Time(0)


class TransformFilter:
    """Adds valid transforms to a tf2 buffer and clears it when time has jumped back.

    tf2 checks only the clock, which arrives over a separate connection. A transform from before the jump may
    arrive after the clock has jumped; tf2 would then reject new transforms older than that one by more than
    the buffer's length. Therefore the stamps of each publisher are checked too.

    Args:
        buffer: The tf2 buffer.
    """

    def __init__(self, buffer: tf2_ros.BufferCore):
        self._buffer = buffer
        self._newest: Dict[Tuple[str, str], float] = {}
        self._lock = threading.Lock()

    def add(self, transforms: Iterable[TransformStamped], publisher: str, is_static: bool = False) -> None:
        """Add transforms; those with invalid stamps are ignored.

        Args:
            transforms: The transforms of a message.
            publisher: Name of the node that published them.
            is_static: Whether they are static.
        """
        usable = [transform for transform in transforms if is_stamp(transform.header.stamp)]
        if is_static:
            for transform in usable:
                self._buffer.set_transform_static(transform, publisher)
            return
        with self._lock:
            for transform in usable:
                self._clear_after_jump(publisher, transform)
                self._buffer.set_transform(transform, publisher)

    def clear(self) -> None:
        """Discard all transforms but the static ones."""
        with self._lock:
            self._clear()

    def _clear_after_jump(self, publisher, transform):
        source, stamp = (publisher, transform.child_frame_id), transform.header.stamp.to_sec()
        if stamp < self._newest.get(source, stamp) - JUMP_BACK_SECONDS:
            self._clear()
        self._newest[source] = max(stamp, self._newest.get(source, stamp))

    def _clear(self):
        self._newest.clear()
        self._buffer.clear()


class _Listener(tf2_ros.TransformListener):
    """tf2's listener, which clears the buffer when the clock jumps, with a TransformFilter."""

    def __init__(self, buffer, transform_filter, **connection):
        self._filter = transform_filter
        super().__init__(buffer, **connection)

    def callback(self, data):
        self._add(data, False)

    def static_callback(self, data):
        self._add(data, True)

    def _add(self, data, is_static):
        self.check_for_reset()
        self._filter.add(data.transforms, data._connection_header.get("callerid", ""), is_static)


class Transforms:
    """Listener and broadcaster of tf for poses in the plane.

    Args:
        cache_seconds: Length of the tf2 buffer [s].

    Attributes:
        buffer: The tf2 buffer.
    """

    def __init__(self, cache_seconds: float = 10.0):
        self.buffer = tf2_ros.Buffer(rospy.Duration(cache_seconds), debug=False)
        self._filter = TransformFilter(self.buffer)
        self._listener = _Listener(self.buffer, self._filter, queue_size=100, tcp_nodelay=True)
        self._broadcaster = tf2_ros.TransformBroadcaster()

    def lookup(self, target: str, source: str, stamp: Optional[rospy.Time] = None) -> Optional[Pose2]:
        """Look up a frame's pose in the plane.

        Args:
            target: Frame in which the pose is given.
            source: Frame whose pose is looked up.
            stamp: Time of the pose; None for the latest.

        Returns:
            The pose of ``source`` in ``target``; None if it is unknown or out of range.
        """
        transform = self._lookup(target, source, stamp)
        return None if transform is None else self._pose_of(transform, target, source)

    def mounting(
        self, base_frame: str, sensor_frame: str, stamp: Optional[rospy.Time] = None
    ) -> Optional[Tuple[Pose2, bool]]:
        """Look up how a sensor is mounted.

        Args:
            base_frame: Frame of the robot.
            sensor_frame: Frame of the sensor.
            stamp: Time; None for the latest.

        Returns:
            The sensor's pose in the base frame and whether it is upside down; None if it is unknown.
        """
        transform = self._lookup(base_frame, sensor_frame, stamp)
        pose = None if transform is None else self._pose_of(transform, base_frame, sensor_frame)
        if transform is None or pose is None:
            return None
        q = transform.rotation
        return pose, 1.0 - 2.0 * (q.x * q.x + q.y * q.y) < 0.0

    def matrix(self, target: str, source: str, stamp: Optional[rospy.Time] = None) -> Optional[np.ndarray]:
        """Look up a frame's pose in space.

        Args:
            target: Frame in which the pose is given.
            source: Frame whose pose is looked up.
            stamp: Time of the pose; None for the latest.

        Returns:
            The pose of ``source`` in ``target``, a matrix (4, 4); None if it is unknown.
        """
        transform = self._lookup(target, source, stamp)
        if transform is None:
            return None
        q, at = transform.rotation, transform.translation
        matrix = np.eye(4)
        matrix[:3, :3] = _rotation(q.x, q.y, q.z, q.w)
        matrix[:3, 3] = at.x, at.y, at.z
        return matrix

    def why_unknown(self, target: str, source: str, stamp: rospy.Time) -> str:
        """Return tf2's reason why a transform is unknown at a stamp; empty if it is known."""
        try:
            self.buffer.lookup_transform(frame_name(target), frame_name(source), stamp)
        except tf2_ros.TransformException as error:
            return str(error)
        return ""

    def latest_stamp(self, target: str, source: str) -> Optional[rospy.Time]:
        """Return the newest time at which the transform is known; None if it is unknown."""
        try:
            return self.buffer.get_latest_common_time(frame_name(target), frame_name(source))
        except tf2_ros.TransformException:
            return None

    def send(self, child_in_parent: Pose2, parent: str, child: str, stamp: rospy.Time) -> None:
        """Publish the pose of a child frame in its parent frame on /tf."""
        self._broadcaster.sendTransform(transform_msg(child_in_parent, parent, child, stamp))

    def add(self, message, is_static: bool = False) -> None:
        """Add a tf2_msgs/TFMessage that was not received by topic, such as one of a bag."""
        self._filter.add(message.transforms, "", is_static)

    def clear(self) -> None:
        """Discard all transforms but the static ones, as after time has jumped back."""
        self._filter.clear()

    def _pose_of(self, transform, target, source):
        try:
            return pose2_of(transform.translation, transform.rotation)
        except MessageError as error:
            rospy.logwarn_throttle(WARN_SECONDS, f"tf: {target} -> {source} ignored: {error}")
            return None

    def _lookup(self, target, source, stamp):
        if stamp is not None and not is_stamp(stamp):
            return None
        try:
            # lookup_transform would first ask whether the transform is known.
            return self.buffer.lookup_transform_core(
                frame_name(target), frame_name(source), stamp or LATEST
            ).transform
        except tf2_ros.TransformException:
            return None


def _rotation(x: float, y: float, z: float, w: float) -> np.ndarray:
    """Return the rotation matrix (3, 3) of a quaternion of any length; the identity for length 0."""
    length = math.sqrt(x * x + y * y + z * z + w * w)
    if length == 0.0:
        return np.eye(3)
    x, y, z, w = x / length, y / length, z / length, w / length
    return np.array(
        [
            [w * w + x * x - y * y - z * z, 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), w * w - x * x + y * y - z * z, 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), w * w - x * x - y * y + z * z],
        ]
    )
