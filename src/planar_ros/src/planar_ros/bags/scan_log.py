"""Scans with odometry, and ground truth, from a bag."""

import math
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Deque, Iterator, Set, Union

import numpy as np
from genpy import Time

from planar import PlanarError, Pose2, Scan
from planar_ros.bags.bag_reader import TF, TF_STATIC, BagError, BagReader, RecordedMessage, absolute_name
from planar_ros.bags.transform_log import TransformLog
from planar_ros.messages.conversion import frame_name, pose2_from_msg, scan_from_msg
from planar_ros.messages.validation import is_stamp

# Longest time by which odometry may lag behind a scan or start after it, in recorded time [s].
_MAX_ODOM_LAG = 2.0
# Scans older than their predecessor by less than this are skipped; otherwise time has jumped back [s].
_JUMP_BACK = 1.0
LASER_SCAN = "sensor_msgs/LaserScan"
KINDS = {TF: "tf2_msgs/TFMessage", TF_STATIC: "tf2_msgs/TFMessage"}


@dataclass(frozen=True, eq=False)
class LoggedScan:
    """A scan of a bag with its odometry.

    Attributes:
        scan: The scan, with the laser's mounting pose.
        laser: Frame of the laser.
        base_in_odom: Odometry at the scan's stamp.
        position: Position of the scan in the bag, as a fraction of its duration (0 to 1).
    """

    scan: Scan
    laser: str
    base_in_odom: Pose2
    position: float


class ScanLog:
    """Iterates over the scans of a bag in order, each with the odometry at its stamp.

    Args:
        path: The bag.
        scan_topic: Topic of the scans (sensor_msgs/LaserScan).
        base_frame: Frame of the robot's base.
        odom_frame: Frame of odometry.
        warn: Called with a text for people, once for each kind of missing, invalid or unordered data.

    Raises:
        BagError: If the bag is unreadable, has no scans on the topic, or topics of another type.
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
        self._warned: Set[str] = set()

    def truth(self, topic: str = "base_pose_ground_truth") -> np.ndarray:
        """Return the ground truth in the bag.

        Args:
            topic: Topic of nav_msgs/Odometry messages with true poses.

        Returns:
            Stamped poses (N, 4) ``[t, x, y, yaw]`` [s, m, m, rad]; N is 0 if the topic was not recorded.
        """
        stamped = [
            (message.header.stamp.to_sec(), *pose2_from_msg(message.pose.pose).as_array())
            for _, message, _ in self._bag.messages([topic])
        ]
        return np.array(stamped).reshape(-1, 4)

    def _check_kind(self, topic: str, kind: str) -> None:
        recorded = self._bag.types.get(topic, kind)
        if recorded != kind:
            raise BagError(f"{self.path}: the messages on {topic} are {recorded}, not {kind}")

    def __iter__(self) -> Iterator[LoggedScan]:
        """Iterate over the scans; those before an error are valid.

        Raises:
            BagError: Where the bag is truncated or broken.
        """
        waiting: Deque[RecordedMessage] = deque()
        for played in self._bag.messages([TF, TF_STATIC, self._scan_topic]):
            if played.topic == self._scan_topic:
                waiting.append(played)
            else:
                self._add_transforms(played)
            while waiting and self._is_due(waiting[0], played.stamp):
                yield from self._with_odometry(waiting.popleft())
        for scan in waiting:
            yield from self._with_odometry(scan)
        if self._bag.truncation:
            raise BagError(f"{self.path}: {self._bag.truncation}")

    def _add_transforms(self, played: RecordedMessage) -> None:
        for pair in self._transforms.add(played.message, is_static=played.topic == TF_STATIC):
            what = f"{TF_STATIC} contradicts itself about {pair}"
            self._warn_once(what, "(using the later one from here on)", played.stamp, self._position(played))

    def _position(self, played: RecordedMessage) -> float:
        return (played.stamp - self._bag.start) / max(self._bag.end - self._bag.start, 1e-9)

    def _is_due(self, scan: RecordedMessage, now: float) -> bool:
        stamp, laser = scan.message.header.stamp, frame_name(scan.message.header.frame_id)
        odometry, mounting = (
            self._transforms.latest_stamp(self._odom, self._base),
            self._transforms.latest_stamp(self._base, laser),
        )
        has_odometry = odometry is not None and odometry >= stamp
        has_mounting = mounting is not None and (mounting == Time(0) or mounting >= stamp)
        return has_odometry and has_mounting or now - scan.stamp > _MAX_ODOM_LAG

    def _with_odometry(self, played: RecordedMessage) -> Iterator[LoggedScan]:
        message, position = played.message, self._position(played)
        stamp = message.header.stamp.to_sec()
        if not is_stamp(message.header.stamp):
            self._warn_once("skipping a scan", "(its stamp is out of range)", stamp, position)
            return
        if stamp < self._last_stamp:
            back = self._last_stamp - stamp
            self._warn_once("time goes back", f"by {back:.3f} s", stamp, position)
            if back < _JUMP_BACK:
                return
            self._transforms.clear()
        self._last_stamp = stamp
        base_in_odom = self._transforms.pose_near(self._odom, self._base, message.header.stamp, _MAX_ODOM_LAG)
        if base_in_odom is None:
            what = f"no transform {self._odom} -> {self._base}"
            frames = ", ".join(self._transforms.frames()) or "none"
            self._warn_once(what, f"(frames: {frames}), assuming a stationary base", stamp, position)
            base_in_odom = self._last_in_odom
        self._last_in_odom = base_in_odom
        laser = frame_name(message.header.frame_id)
        mounting = self._transforms.mounting(self._base, laser, message.header.stamp)
        if mounting is None:
            what = f"no transform {self._base} -> {laser},"
            self._warn_once(what, f"assuming the laser at the origin of {self._base}", stamp, position)
            mounting = (Pose2(), False)
        try:
            scan = scan_from_msg(message, *mounting)
        except PlanarError as error:
            self._warn_once("skipping a scan", f"({error})", stamp, position)
            return
        yield LoggedScan(scan, laser, base_in_odom, position)

    def _warn_once(self, what: str, details: str, stamp: float, position: float) -> None:
        if what not in self._warned:
            self._warned.add(what)
            self._warn(
                f"{self.path}: {what} {details}, at stamp {stamp:.3f}, {100.0 * position:.0f} % into the bag"
            )
