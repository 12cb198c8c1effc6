"""The condition for an update: motion, time or request."""

from typing import Optional, Set

from amcl_lite.config import LocalizerSettings
from planar import Pose2, wrap


class UpdatePolicy:
    """Decides which scans are used: the first one, and one of each laser after motion, time or a request.

    Attributes:
        updated_at: Odometry pose of the last update, or None.
    """

    def __init__(self, updated_at: Optional[Pose2] = None) -> None:
        self.updated_at = updated_at
        self._updated_stamp = 0.0
        self._lasers_done: Set[str] = set()
        self._is_requested = True

    def request(self) -> None:
        """Use the next scan even if the robot has not moved."""
        self._is_requested = True

    def is_due(self, base_in_odom: Pose2, laser: str, stamp: float, settings: LocalizerSettings) -> bool:
        """Return whether to use a scan of ``laser`` with this odometry pose and ``stamp`` [s]."""
        if (
            self.updated_at is None
            or _has_moved(self.updated_at, base_in_odom, settings)
            or self._has_stood_long(stamp, settings)
            or self._is_requested
        ):
            self._is_requested = False
            self._updated_stamp = stamp
            self._lasers_done.clear()
        return laser not in self._lasers_done

    def record_update(self, base_in_odom: Pose2, laser: str) -> None:
        """Record that a scan is used."""
        self.updated_at = base_in_odom
        self._lasers_done.add(laser)

    def _has_stood_long(self, stamp: float, settings: LocalizerSettings) -> bool:
        return abs(stamp - self._updated_stamp) * settings.update_when_still >= 1.0


def _has_moved(before: Pose2, base_in_odom: Pose2, settings: LocalizerSettings) -> bool:
    return (
        abs(base_in_odom.x - before.x) > settings.update_min_distance
        or abs(base_in_odom.y - before.y) > settings.update_min_distance
        or abs(wrap(base_in_odom.yaw - before.yaw)) > settings.update_min_angle
    )
