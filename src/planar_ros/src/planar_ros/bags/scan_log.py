"""Scans, odometry and the truth out of a bag, without a master."""

import math
import shutil
import tempfile
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Deque, Dict, Iterator, List, Optional, Set, Tuple

import numpy as np
import rosbag
import tf2_py
from genpy import Duration, Time
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from std_msgs.msg import Header

from planar import PlanarError, Pose2, Scan
from planar_ros.messages.conversion import frame_name, pose2_from_msg, scan_from_msg, yaw_of

# Odometry may lag behind or start after a scan by this much, seconds of the bag's time.
_PATIENCE = 2.0
_JUMP_BACK = 1.0


class BagError(PlanarError):
    """A bag cannot be read, or not to its end; the text says where it broke."""


@dataclass(frozen=True, eq=False)
class LoggedScan:
    """A scan of the laser with that frame, where odometry believed the base to be, and how far into the bag.

    ``position``: the share of the bag, 0 to 1, that the scan lies at.
    """

    scan: Scan
    laser: str
    base_in_odom: Pose2
    position: float


class ScanLog:
    """The scans of a bag in order, each with the odometry at its stamp.

    ``warn`` is told, once each, of what is missing or out of order.
    """

    def __init__(self, path, scan_topic: str, base_frame: str, odom_frame: str, warn: Callable[[str], None]):
        self._path, self._warn = path, warn
        self._scan_topic, self._base, self._odom = scan_topic, frame_name(base_frame), frame_name(odom_frame)
        self._bag, self._is_cut_off = open_bag(path)
        topics = self._bag.get_type_and_topic_info().topics
        if scan_topic not in topics:
            there = ", ".join(sorted(topics)) or "none"
            raise BagError(f"{path}: no scans on {scan_topic}; topics: {there}")
        self._start, self._end = self._bag.get_start_time(), self._bag.get_end_time()
        self._transforms = _TransformLog()
        self._last_in_odom = Pose2()
        self._last_stamp = -math.inf
        self._told: Set[str] = set()

    def truth(self, topic: str = "base_pose_ground_truth") -> np.ndarray:
        """Stamps and true poses (N, 4) ``[t, x, y, yaw]`` of nav_msgs/Odometry messages, often none."""
        stamped = [
            (message.header.stamp.to_sec(), *pose2_from_msg(message.pose.pose).as_array())
            for _, message, _ in self._bag.read_messages([topic, "/" + topic])
        ]
        return np.array(stamped).reshape(-1, 4)

    def __iter__(self) -> Iterator[LoggedScan]:
        """Raises BagError where the bag breaks off; what was read before is good."""
        waiting: Deque[Tuple[float, Any]] = deque()
        for topic, message, now in self._messages():
            if topic == self._scan_topic:
                waiting.append((now, message))
            else:
                self._transforms.add(message, is_static=topic == "/tf_static")
            while waiting and self._is_ripe(waiting[0], now):
                yield from self._with_odometry(*waiting.popleft())
        for entry in waiting:
            yield from self._with_odometry(*entry)
        if self._is_cut_off:
            raise BagError(f"{self._path}: cut off {self._end - self._start:.1f} s after its start")

    def _messages(self) -> Iterator[Tuple[str, Any, float]]:
        now = self._start
        messages = self._bag.read_messages(["/tf", "/tf_static", self._scan_topic])
        while True:
            try:
                topic, message, recorded = next(messages)
            except StopIteration:
                return
            except Exception as error:  # rosbag lets pass whatever struct, bz2 and genpy raise
                after = f"broken {now - self._start:.1f} s after its start"
                raise BagError(f"{self._path}: {after} ({error or type(error).__name__})") from None
            now = recorded.to_sec()
            yield topic, message, now

    def _is_ripe(self, entry: Tuple[float, Any], now: float) -> bool:
        recorded, message = entry
        latest = self._transforms.latest_stamp(self._odom, self._base)
        return now - recorded > _PATIENCE or (latest is not None and latest >= message.header.stamp)

    def _with_odometry(self, recorded: float, message) -> Iterator[LoggedScan]:
        position = (recorded - self._start) / max(self._end - self._start, 1e-9)
        stamp = message.header.stamp.to_sec()
        if stamp < self._last_stamp:
            back = self._last_stamp - stamp
            self._tell("time goes back", f"by {back:.3f} s", stamp, position)
            if back < _JUMP_BACK:
                return
            self._transforms.clear()
        self._last_stamp = stamp
        base_in_odom = self._transforms.pose_near(self._odom, self._base, message.header.stamp, _PATIENCE)
        if base_in_odom is None:
            what = f"no transform {self._odom} -> {self._base}"
            frames = ", ".join(self._transforms.frames()) or "none"
            self._tell(what, f"(frames: {frames}), taking the base to stand still", stamp, position)
            base_in_odom = self._last_in_odom
        self._last_in_odom = base_in_odom
        laser = frame_name(message.header.frame_id)
        mounting = self._transforms.mounting(self._base, laser)
        if mounting is None:
            self._tell(
                f"no transform {self._base} -> {laser}",
                "so the laser is taken to be the base",
                stamp,
                position,
            )
            mounting = (Pose2(), False)
        yield LoggedScan(scan_from_msg(message, *mounting), laser, base_in_odom, position)

    def _tell(self, what: str, details: str, stamp: float, position: float) -> None:
        if what not in self._told:
            self._told.add(what)
            self._warn(
                f"{self._path}: {what} {details}, at stamp {stamp:.3f}, {100.0 * position:.0f} % into the bag"
            )


class _TransformLog:
    """The transforms of a bag as far as it has been read."""

    def __init__(self) -> None:
        self._static: List[Any] = []
        self._frames: Set[str] = set()
        self.clear()

    def clear(self) -> None:
        self._buffer = tf2_py.BufferCore(Duration(30.0))
        self._newest: Dict[str, Time] = {}
        for transform in self._static:
            self._buffer.set_transform_static(transform, "bag")

    def add(self, message, is_static: bool) -> None:
        for logged in message.transforms:
            transform = _typed(logged)
            parent, child = transform.header.frame_id, transform.child_frame_id
            self._frames |= {parent, child}
            if is_static:
                self._static.append(transform)
                self._buffer.set_transform_static(transform, "bag")
            elif self._newest.get(child) != transform.header.stamp:
                self._newest[child] = transform.header.stamp
                self._buffer.set_transform(transform, "bag")

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
        if transform is None:
            return None
        return Pose2(transform.translation.x, transform.translation.y, yaw_of(transform.rotation))

    def mounting(self, base: str, sensor: str) -> Optional[Tuple[Pose2, bool]]:
        """The pose of a sensor on its base, and whether it hangs upside down."""
        transform = self._lookup(base, sensor, Time(0))
        if transform is None:
            return None
        q = transform.rotation
        upside_down = 1.0 - 2.0 * (q.x * q.x + q.y * q.y) < 0.0
        return Pose2(transform.translation.x, transform.translation.y, yaw_of(q)), upside_down

    def frames(self) -> List[str]:
        return sorted(self._frames)

    def _lookup(self, target: str, source: str, stamp):
        try:
            return self._buffer.lookup_transform_core(target, source, stamp).transform
        except tf2_py.TransformException:
            return None


def _typed(logged) -> TransformStamped:
    """A transform of the types that tf2 wants; rosbag makes types of its own."""
    v, q = logged.transform.translation, logged.transform.rotation
    return TransformStamped(
        Header(stamp=logged.header.stamp, frame_id=frame_name(logged.header.frame_id)),
        frame_name(logged.child_frame_id),
        Transform(Vector3(v.x, v.y, v.z), Quaternion(q.x, q.y, q.z, q.w)),
    )


def open_bag(path) -> Tuple[rosbag.Bag, bool]:
    """The bag, and whether its end is missing."""
    try:
        return rosbag.Bag(str(path)), False
    except rosbag.ROSBagUnindexedException:
        return _without_end(path), True
    except (OSError, rosbag.ROSBagException) as error:
        raise BagError(f"{path}: not a readable bag ({error})") from None


def _without_end(path) -> rosbag.Bag:
    """The complete part of a bag, from a copy: rosbag repairs the file itself."""
    try:
        with tempfile.TemporaryDirectory() as folder:
            copy = str(Path(folder) / "copy.bag")
            shutil.copyfile(path, copy)
            with rosbag.Bag(copy, "a", allow_unindexed=True) as broken:
                for _ in broken.reindex():
                    pass
            bag = rosbag.Bag(copy)  # which stays open when the folder has gone
        count = bag.get_message_count()
    except Exception as error:  # rosbag lets pass whatever struct, bz2 and genpy raise
        raise BagError(f"{path}: not a readable bag ({error or type(error).__name__})") from None
    if count == 0:
        raise BagError(f"{path}: cut off before the first complete chunk of messages")
    return bag
