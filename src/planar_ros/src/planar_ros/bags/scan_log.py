"""Scans, odometry and the truth out of a bag, without a master."""

import math
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Deque, Iterator, Set, Union

import numpy as np

from planar import PlanarError, Pose2, Scan
from planar_ros.bags.bag_reader import TF, TF_STATIC, BagError, BagReader, RecordedMessage, absolute_name
from planar_ros.bags.transform_log import TransformLog
from planar_ros.messages.conversion import frame_name, pose2_from_msg, scan_from_msg
from planar_ros.messages.validation import is_stamp

# Odometry may lag behind or start after a scan by this much, seconds of the bag's time.
_PATIENCE = 2.0
_JUMP_BACK = 1.0
LASER_SCAN = "sensor_msgs/LaserScan"
KINDS = {TF: "tf2_msgs/TFMessage", TF_STATIC: "tf2_msgs/TFMessage"}


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

    def __init__(
        self,
        path: Union[str, Path],
        scan_topic: str,
        base_frame: str,
        odom_frame: str,
        warn: Callable[[str], None],
    ):
        self._bag, self._warn = BagReader(path), warn
        self._scan_topic = absolute_name(scan_topic)
        self._base, self._odom = frame_name(base_frame), frame_name(odom_frame)
        self.path = self._bag.path
        if self._scan_topic not in self._bag.types:
            there = ", ".join(sorted(self._bag.types)) or "none"
            raise BagError(f"{path}: no scans on {scan_topic}; topics: {there}")
        for topic, kind in KINDS.items():
            self._check_kind(topic, kind)
        self._check_kind(self._scan_topic, LASER_SCAN)
        self._transforms = TransformLog(self._bag.first_static_transforms())
        self._last_in_odom = Pose2()
        self._last_stamp = -math.inf
        self._told: Set[str] = set()

    def truth(self, topic: str = "base_pose_ground_truth") -> np.ndarray:
        """Stamps and true poses (N, 4) ``[t, x, y, yaw]`` of nav_msgs/Odometry messages, often none."""
        stamped = [
            (message.header.stamp.to_sec(), *pose2_from_msg(message.pose.pose).as_array())
            for _, message, _ in self._bag.messages([topic])
        ]
        return np.array(stamped).reshape(-1, 4)

    def _check_kind(self, topic: str, kind: str) -> None:
        told = self._bag.types.get(topic, kind)
        if told != kind:
            raise BagError(f"{self.path}: the messages on {topic} are {told}, not {kind}")

    def __iter__(self) -> Iterator[LoggedScan]:
        """Raises BagError where the bag breaks off; what was read before is good."""
        waiting: Deque[RecordedMessage] = deque()
        for played in self._bag.messages([TF, TF_STATIC, self._scan_topic]):
            if played.topic == self._scan_topic:
                waiting.append(played)
            else:
                self._add_transforms(played)
            while waiting and self._is_ripe(waiting[0], played.stamp):
                yield from self._with_odometry(waiting.popleft())
        for scan in waiting:
            yield from self._with_odometry(scan)
        if self._bag.truncation:
            raise BagError(f"{self.path}: {self._bag.truncation}")

    def _add_transforms(self, played: RecordedMessage) -> None:
        for pair in self._transforms.add(played.message, is_static=played.topic == TF_STATIC):
            what = f"{TF_STATIC} contradicts itself about {pair}"
            self._tell(what, "(from now on the later one holds)", played.stamp, self._position(played))

    def _position(self, played: RecordedMessage) -> float:
        return (played.stamp - self._bag.start) / max(self._bag.end - self._bag.start, 1e-9)

    def _is_ripe(self, scan: RecordedMessage, now: float) -> bool:
        latest = self._transforms.latest_stamp(self._odom, self._base)
        return now - scan.stamp > _PATIENCE or (latest is not None and latest >= scan.message.header.stamp)

    def _with_odometry(self, played: RecordedMessage) -> Iterator[LoggedScan]:
        message, position = played.message, self._position(played)
        stamp = message.header.stamp.to_sec()
        if not is_stamp(message.header.stamp):
            self._tell("a scan is left out", "(its stamp means nothing)", stamp, position)
            return
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
        try:
            scan = scan_from_msg(message, *mounting)
        except PlanarError as error:
            self._tell("a scan is left out", f"({error})", stamp, position)
            return
        yield LoggedScan(scan, laser, base_in_odom, position)

    def _tell(self, what: str, details: str, stamp: float, position: float) -> None:
        if what not in self._told:
            self._told.add(what)
            self._warn(
                f"{self.path}: {what} {details}, at stamp {stamp:.3f}, {100.0 * position:.0f} % into the bag"
            )
