"""Transforms of a bag, as far as it has been read."""

from typing import Any, Dict, Iterable, List, Optional, Tuple

import numpy as np
import tf2_py
from genpy import Duration, Time
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from std_msgs.msg import Header

from planar import Pose2
from planar_ros.messages.conversion import frame_name, pose2_of
from planar_ros.messages.validation import MessageError, is_stamp

# Static transforms that differ by less are equal [m, or components of the quaternion].
_ROUNDING = 1e-4


class TransformLog:
    """Looks up poses of frames in the transforms added so far.

    Args:
        static: Static transforms that hold from the start of the bag.
    """

    def __init__(self, static: Iterable[Any]) -> None:
        self._static: Dict[str, TransformStamped] = {}
        for transform in map(typed, static):
            if is_stamp(transform.header.stamp):
                self._static[transform.child_frame_id] = transform
        self._frames = {
            name for one in self._static.values() for name in (one.header.frame_id, one.child_frame_id)
        }
        self._earliest: Optional[tf2_py.BufferCore] = None
        self.clear()

    def clear(self) -> None:
        """Discard all transforms but the static ones."""
        self._buffer = tf2_py.BufferCore(Duration(30.0))
        self._newest: Dict[str, Time] = {}
        for transform in self._static.values():
            self._buffer.set_transform_static(transform, "bag")

    def add(self, message, is_static: bool) -> List[str]:
        """Add the transforms of a message.

        Args:
            message: A tf2_msgs/TFMessage.
            is_static: Whether it was recorded on /tf_static.

        Returns:
            "parent -> child" of each static transform that differs from the one known before.
        """
        contradicted: List[str] = []
        for logged in message.transforms:
            transform = typed(logged)
            parent, child = transform.header.frame_id, transform.child_frame_id
            self._frames |= {parent, child}
            if not is_stamp(transform.header.stamp):
                continue
            if is_static:
                known = self._static.get(child)
                if known is not None and not is_same(known, transform):
                    contradicted.append(f"{known.header.frame_id} -> {child}")
                self._static[child] = transform
                self._buffer.set_transform_static(transform, "bag")
            elif self._newest.get(child) != transform.header.stamp:
                self._newest[child] = transform.header.stamp
                self._buffer.set_transform(transform, "bag")
        return contradicted

    def latest_stamp(self, target: str, source: str) -> Optional[Time]:
        """Return the newest time at which the transform is known; None if it is unknown."""
        try:
            return self._buffer.get_latest_common_time(target, source)
        except tf2_py.TransformException:
            return None

    def pose_near(self, target: str, source: str, stamp, tolerance: float) -> Optional[Pose2]:
        """Return a frame's pose at a stamp, or the latest one if that is close enough.

        Args:
            target: Frame in which the pose is given.
            source: Frame whose pose is looked up.
            stamp: Time of the pose.
            tolerance: Longest time between ``stamp`` and the latest transform, used if there is none at
                ``stamp`` [s].

        Returns:
            The pose of ``source`` in ``target``; None if it is unknown or out of range.
        """
        latest = self.latest_stamp(target, source)
        if latest is None:
            return None
        transform = self._lookup(target, source, stamp)
        if transform is None and abs((latest - stamp).to_sec()) <= tolerance:
            transform = self._lookup(target, source, Time(0))
        return None if transform is None else self._pose_of(transform)

    def set_earliest(self, transforms: Iterable[Any]) -> None:
        """Set the first transform of each frame in the bag, for sensor data from before these."""
        self._earliest = tf2_py.BufferCore()
        for transform in map(typed, transforms):
            if is_stamp(transform.header.stamp):
                self._earliest.set_transform_static(transform, "bag")

    def mounting(self, base: str, sensor: str, stamp) -> Optional[Tuple[Pose2, bool]]:
        """Return how a sensor was mounted at a stamp.

        Args:
            base: Frame of the base.
            sensor: Frame of the sensor.
            stamp: Time of the pose. If it is not known at that time, the latest one is returned, or that of
                ``set_earliest``.

        Returns:
            The sensor's pose in the base frame and whether it is mounted upside down; None if unknown.
        """
        transform = self._lookup(base, sensor, stamp) or self._lookup(base, sensor, Time(0))
        if transform is None and self._earliest is not None:
            transform = _lookup_in(self._earliest, base, sensor, Time(0))
        pose = None if transform is None else self._pose_of(transform)
        if transform is None or pose is None:
            return None
        q = transform.rotation
        return pose, 1.0 - 2.0 * (q.x * q.x + q.y * q.y) < 0.0

    def frames(self) -> List[str]:
        """Return the names of all frames seen so far, sorted."""
        return sorted(self._frames)

    def _pose_of(self, transform) -> Optional[Pose2]:
        """Return the pose in the plane; None if it is out of range."""
        try:
            return pose2_of(transform.translation, transform.rotation)
        except MessageError:
            return None

    def _lookup(self, target: str, source: str, stamp):
        return _lookup_in(self._buffer, target, source, stamp)


def _lookup_in(buffer: tf2_py.BufferCore, target: str, source: str, stamp):
    if not is_stamp(stamp):
        return None
    try:
        return buffer.lookup_transform_core(target, source, stamp).transform
    except tf2_py.TransformException:
        return None


def is_same(one: TransformStamped, other: TransformStamped) -> bool:
    """Whether two transforms have the same parent and, up to rounding, the same pose."""
    a, b = (
        np.array([getattr(part, axis) for part in (t.translation, t.rotation) for axis in part.__slots__])
        for t in (one.transform, other.transform)
    )
    negated = np.concatenate((b[:3], -b[3:]))  # q and -q are the same rotation
    is_close = min(np.abs(a - b).max(), np.abs(a - negated).max()) < _ROUNDING
    return one.header.frame_id == other.header.frame_id and bool(is_close)


def typed(logged) -> TransformStamped:
    """Convert a transform to the classes tf2 needs; rosbag generates separate ones."""
    v, q = logged.transform.translation, logged.transform.rotation
    return TransformStamped(
        Header(stamp=logged.header.stamp, frame_id=frame_name(logged.header.frame_id)),
        frame_name(logged.child_frame_id),
        Transform(Vector3(v.x, v.y, v.z), Quaternion(q.x, q.y, q.z, q.w)),
    )
