"""The transforms of a bag as far as it has been read."""

from typing import Any, Dict, Iterable, List, Optional, Tuple

import numpy as np
import tf2_py
from genpy import Duration, Time
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from std_msgs.msg import Header

from planar import Pose2
from planar_ros.messages.conversion import frame_name, pose2_of
from planar_ros.messages.validation import MessageError, is_stamp

# Static transforms that differ by less, metres or parts of a quaternion, are the same.
_ROUNDING = 1e-4


class TransformLog:
    """Answers where a frame lies in another, by the transforms that it was given.

    ``static``: transforms that hold from the start.
    """

    def __init__(self, static: Iterable[Any]) -> None:
        self._static: Dict[str, TransformStamped] = {}
        for typed in map(_typed, static):
            if is_stamp(typed.header.stamp):
                self._static[typed.child_frame_id] = typed
        self._frames = {
            name for one in self._static.values() for name in (one.header.frame_id, one.child_frame_id)
        }
        self.clear()

    def clear(self) -> None:
        """Forgets all but the static ones."""
        self._buffer = tf2_py.BufferCore(Duration(30.0))
        self._newest: Dict[str, Time] = {}
        for transform in self._static.values():
            self._buffer.set_transform_static(transform, "bag")

    def add(self, message, is_static: bool) -> List[str]:
        """Takes in a message; returns the static transforms in it that contradict what held so far."""
        contradicted: List[str] = []
        for logged in message.transforms:
            transform = _typed(logged)
            parent, child = transform.header.frame_id, transform.child_frame_id
            self._frames |= {parent, child}
            if not is_stamp(transform.header.stamp):
                continue
            if is_static:
                known = self._static.get(child)
                if known is not None and not _is_same(known, transform):
                    contradicted.append(f"{known.header.frame_id} -> {child}")
                self._static[child] = transform
                self._buffer.set_transform_static(transform, "bag")
            elif self._newest.get(child) != transform.header.stamp:
                self._newest[child] = transform.header.stamp
                self._buffer.set_transform(transform, "bag")
        return contradicted

    def latest_stamp(self, target: str, source: str) -> Optional[Time]:
        try:
            return self._buffer.get_latest_common_time(target, source)
        except tf2_py.TransformException:
            return None

    def pose_near(self, target: str, source: str, stamp, tolerance: float) -> Optional[Pose2]:
        """Where ``source`` lies in ``target`` at ``stamp``, or else at most ``tolerance`` s later."""
        latest = self.latest_stamp(target, source)
        if latest is None:
            return None
        transform = self._lookup(target, source, stamp)
        if transform is None and abs((latest - stamp).to_sec()) <= tolerance:
            transform = self._lookup(target, source, Time(0))
        return None if transform is None else self._pose_of(transform)

    def mounting(self, base: str, sensor: str) -> Optional[Tuple[Pose2, bool]]:
        """The pose of a sensor on its base, and whether it hangs upside down."""
        transform = self._lookup(base, sensor, Time(0))
        pose = None if transform is None else self._pose_of(transform)
        if transform is None or pose is None:
            return None
        q = transform.rotation
        return pose, 1.0 - 2.0 * (q.x * q.x + q.y * q.y) < 0.0

    def frames(self) -> List[str]:
        return sorted(self._frames)

    def _pose_of(self, transform) -> Optional[Pose2]:
        """None for a place where nothing can be."""
        try:
            return pose2_of(transform.translation, transform.rotation)
        except MessageError:
            return None

    def _lookup(self, target: str, source: str, stamp):
        if not is_stamp(stamp):
            return None
        try:
            return self._buffer.lookup_transform_core(target, source, stamp).transform
        except tf2_py.TransformException:
            return None


def _is_same(one: TransformStamped, other: TransformStamped) -> bool:
    """Whether two transforms have the same parent and, but for rounding, put the child to the same place."""
    a, b = (
        np.array([getattr(part, axis) for part in (t.translation, t.rotation) for axis in part.__slots__])
        for t in (one.transform, other.transform)
    )
    turned = np.concatenate((b[:3], -b[3:]))  # the same rotation
    near = min(np.abs(a - b).max(), np.abs(a - turned).max()) < _ROUNDING
    return one.header.frame_id == other.header.frame_id and bool(near)


def _typed(logged) -> TransformStamped:
    """A transform of the types that tf2 wants; rosbag makes types of its own."""
    v, q = logged.transform.translation, logged.transform.rotation
    return TransformStamped(
        Header(stamp=logged.header.stamp, frame_id=frame_name(logged.header.frame_id)),
        frame_name(logged.child_frame_id),
        Transform(Vector3(v.x, v.y, v.z), Quaternion(q.x, q.y, q.z, q.w)),
    )
