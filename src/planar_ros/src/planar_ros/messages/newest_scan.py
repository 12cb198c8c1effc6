"""Newest scan, placed where the laser was at its stamp."""

import threading
from collections import deque
from typing import Deque, Optional, Tuple

from planar import Scan
from planar_ros.messages.conversion import LaserScanArrays, frame_name, scan_from_msg
from planar_ros.messages.transforms import Transforms

# Scans that may wait for the transform of their laser.
WAITING_SCANS = 5


class NewestScan:
    """Keeps scans until the mounting pose of their laser at their stamp is known.

    The transform of a laser on a turning mount may arrive after the scan, and its latest one belongs to
    another moment.

    Args:
        transforms: Source of mounting poses.
        base_frame: Frame of the robot's base.
    """

    def __init__(self, transforms: Transforms, base_frame: str):
        self._transforms, self._base_frame = transforms, base_frame
        self._lock = threading.Lock()
        self._waiting: Deque[Tuple[LaserScanArrays, float]] = deque(maxlen=WAITING_SCANS)
        self._placed: Optional[Tuple[Scan, float]] = None

    def add(self, message: LaserScanArrays, now: float) -> None:
        """Add a scan.

        Args:
            message: The scan.
            now: ROS time at which it was received [s].
        """
        with self._lock:
            self._waiting.append((message, now))

    def latest(self) -> Optional[Tuple[Scan, float]]:
        """Return the newest scan whose mounting pose is known and when it was received [s]; None without."""
        with self._lock:
            for number in range(len(self._waiting) - 1, -1, -1):
                message, received = self._waiting[number]
                frame, stamp = frame_name(message.header.frame_id), message.header.stamp
                mounting = self._transforms.mounting(self._base_frame, frame, stamp)
                if mounting is not None:
                    self._placed = scan_from_msg(message, *mounting), received
                    for _ in range(number + 1):
                        self._waiting.popleft()
                    break
            return self._placed

    def missing(self) -> str:
        """Return the transform that the newest waiting scan lacks, for people; empty if none waits."""
        with self._lock:
            if not self._waiting:
                return ""
            header = self._waiting[-1][0].header
        return f"{self._base_frame} -> {frame_name(header.frame_id)} at {header.stamp.to_sec():.3f}"

    def clear(self) -> None:
        """Discard all scans, as after time has jumped back."""
        with self._lock:
            self._waiting.clear()
            self._placed = None
