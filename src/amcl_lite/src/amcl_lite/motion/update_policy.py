"""When a scan is worked into the filter."""

from typing import Optional, Set

from amcl_lite.config import LocalizerSettings
from planar import Pose2, wrap


class UpdatePolicy:
    """The first scan counts; after a motion, a long stand or a request, each laser's next scan does, once.

    ``updated_at``: where the odometry had the robot when it was last known where it is, if it was; from then
    on, where the last scan that was taken was made.
    """

    def __init__(self, updated_at: Optional[Pose2] = None) -> None:
        self.updated_at = updated_at
        self._updated_stamp = 0.0
        self._lasers_done: Set[str] = set()
        self._is_requested = True

    def request(self) -> None:
        """Makes the next scan count even if the robot stands still."""
        self._is_requested = True

    def is_due(self, base_in_odom: Pose2, laser: str, stamp: float, settings: LocalizerSettings) -> bool:
        """Whether a scan of ``laser``, made at ``base_in_odom`` and ``stamp`` (seconds), is to be taken."""
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
        """Notes that a scan is taken."""
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
