"""Scans with odometry, and ground truth, from a bag."""

import contextlib
import math
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Deque, Dict, Iterator, Set, Tuple, Union

import numpy as np

from planar import PlanarError, Pose2, Scan
from planar_ros.bags.bag_reader import (
    LASER_SCAN,
    TF,
    TF_MESSAGE,
    TF_STATIC,
    BagError,
    BagReader,
    RecordedMessage,
    absolute_name,
)
from planar_ros.bags.frames import find_frames, read_tree
from planar_ros.bags.transform_log import TransformLog
from planar_ros.messages.conversion import frame_name, pose2_from_msg, scan_from_msg
from planar_ros.messages.validation import is_stamp

# Longest time by which odometry may lag behind a scan or start after it, in recorded time [s].
_MAX_ODOM_LAG = 2.0
# Scans older than their predecessor by less than this are skipped; otherwise time has jumped back [s].
_JUMP_BACK = 1.0


class NoResultError(BagError):
    """A bag is readable, but nothing can be mapped or localized with it."""


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
        base_frame: Frame of the robot's base; if it does not move in the bag, the frame that does is used.
        odom_frame: Frame of odometry; likewise.
        warn: Called with a text for people, once for each kind of missing, invalid or unordered data.

    Attributes:
        frames: The frames that are used.

    Raises:
        NoResultError: If the bag has no scans on the topic.
        BagError: If the bag is unreadable, has topics of another type, or the base is one of several
            moving frames.
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
        self.path = self._bag.path
        if self._scan_topic not in self._bag.types:
            raise NoResultError(f"{path}: no scans on {scan_topic}; {_topics_of(self._bag)}")
        for topic, kind in ((TF, TF_MESSAGE), (TF_STATIC, TF_MESSAGE), (self._scan_topic, LASER_SCAN)):
            self._check_kind(topic, kind)
        self.frames = find_frames(self._bag, odom_frame, base_frame, self._first_laser())
        if self.frames.substitution:
            warn(f"{path}: {self.frames.substitution}")
        self._transforms = TransformLog(read_tree(self._bag, [TF_STATIC]).first.values())
        self._has_looked_ahead = False
        self._last_in_odom = Pose2()
        self._last_stamp = -math.inf
        self._warned: Set[str] = set()
        # Frames of the lasers so far, in order, and those whose mounting is unknown.
        self._lasers: Dict[str, None] = {}
        self._unmounted: Set[str] = set()

    def __str__(self) -> str:
        """What was taken for what, for messages to people."""
        frames = self.frames
        odometry = f"odometry {frames.odom} -> {frames.base}" if frames.has_odometry else "no odometry"
        lasers = ", ".join(
            name
            if name not in self._unmounted
            else f"{name}, taken for mounted at the origin of {frames.base}"
            for name in self._lasers
        )
        return f"scans of {self._scan_topic} ({lasers or 'none usable'}), {odometry}"

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

    def _first_laser(self) -> str:
        """Frame of the first scan; empty if it cannot be read."""
        with contextlib.suppress(BagError):  # raised again when the scans are read
            for played in self._bag.messages([self._scan_topic]):
                return frame_name(played.message.header.frame_id)
        return ""

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
        odom, laser = self.frames.odom, frame_name(scan.message.header.frame_id)
        latest = self._transforms.latest_stamp(odom, laser)  # of odometry and of a mounting that moves
        latest = latest or self._transforms.latest_stamp(odom, self.frames.base)
        is_complete = latest is not None and latest >= scan.message.header.stamp
        return is_complete or now - scan.stamp > _MAX_ODOM_LAG

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
        self._last_in_odom = base_in_odom = self._odometry_at(message.header.stamp, position)
        laser = frame_name(message.header.frame_id)
        mounting = self._mounting_at(laser, message.header.stamp, position)
        try:
            scan = scan_from_msg(message, *mounting)
        except PlanarError as error:
            self._warn_once("skipping a scan", f"({error})", stamp, position)
            return
        self._lasers[laser] = None
        yield LoggedScan(scan, laser, base_in_odom, position)

    def _odometry_at(self, stamp, position: float) -> Pose2:
        odom, base = self.frames.odom, self.frames.base
        base_in_odom = self._transforms.pose_near(odom, base, stamp, _MAX_ODOM_LAG)
        if base_in_odom is not None:
            return base_in_odom
        frames = ", ".join(self._transforms.frames()) or "none"
        details = f"(frames: {frames}), assuming a stationary base"
        self._warn_once(f"no transform {odom} -> {base}", details, stamp.to_sec(), position)
        return self._last_in_odom

    def _mounting_at(self, laser: str, stamp, position: float) -> Tuple[Pose2, bool]:
        """Mounting of a laser, also from later in the bag."""
        base = self.frames.base
        mounting = self._transforms.mounting(base, laser, stamp)
        if mounting is None and not self._has_looked_ahead:
            self._has_looked_ahead = True
            self._transforms.set_earliest(read_tree(self._bag, [TF_STATIC, TF]).first.values())
            mounting = self._transforms.mounting(base, laser, stamp)
        if mounting is not None:
            return mounting
        self._unmounted.add(laser)
        details = f"assuming the laser at the origin of {base}"
        self._warn_once(f"no transform {base} -> {laser},", details, stamp.to_sec(), position)
        return Pose2(), False

    def _warn_once(self, what: str, details: str, stamp: float, position: float) -> None:
        if what not in self._warned:
            self._warned.add(what)
            self._warn(
                f"{self.path}: {what} {details}, at stamp {stamp:.3f}, {100.0 * position:.0f} % into the bag"
            )


def _topics_of(bag: BagReader) -> str:
    """List the topics of a bag for people, and separately those with scans."""
    text = f"topics: {', '.join(sorted(bag.types)) or 'none'}"
    scans = sorted(topic for topic, kind in bag.types.items() if kind == LASER_SCAN)
    return f"{text}; topics with scans: {', '.join(scans)}" if scans else text
