"""Sensors that are dead and look alive: each is held against what the others and the commands say."""

import math
from dataclasses import dataclass
from typing import Optional

import numpy as np

from move_base_lite.plausibility.wheel_monitor import WheelMonitor
from planar import Pose2, Twist2

# Of the beams of a scan: so many of a kind are no chance.
NEARLY_ALL = 0.95
# A scan that shows that much is not followed by one that shows nothing, before the robot has gone far.
ENOUGH = 0.5
NOT_FAR = 0.3
# Radians: a sensor that looks around always has something in sight within a room. One that looks ahead, as a
# depth camera, has not, before a wall that is too near, or into the open; turned by that share of its view
# it sees something else.
ALL_AROUND = math.radians(120.0)
SAME_VIEW = 0.25
# Motion, metres or radians, in which a scan with noise cannot stay the same to the last bit; between so many
# scans, and between two of them at least.
NOTICEABLE, ENOUGH_SCANS, LEAST_STEP = 0.15, 3, 0.005
# Seconds of a command, and its speed in m/s or rad/s, after which odometry must have moved.
PATIENCE = 1.0
FAST = 0.1
# Metres by which beams have changed if the robot has truly moved; the median of all.
CHANGED = 0.1
# Seconds without odometry that had come before. Scans that stay away are what expected_update_rate is for.
SILENCE = 2.0


@dataclass(frozen=True)
class _View:
    """Where the robot was when its scan showed enough, and how far it can go until that is out of range."""

    base: Pose2
    room: float


class SensorMonitor:
    """Told what scans, odometry and commands say, it says which sensor cannot be trusted now.

    Scans are held against themselves, against the scans before, and against odometry; odometry against
    commands and scans; the wheels against both. What is not known to be wrong is trusted: a scan without a
    single return may be that of an empty hall, unless the robot has just seen walls all around.
    """

    def __init__(self) -> None:
        self._base = Pose2()
        self._odometry_at: Optional[float] = None
        self._still_since: Optional[float] = None
        self._scan_when_still: Optional[np.ndarray] = None
        self._ranges: Optional[np.ndarray] = None
        self._base_at_scan, self._same_way, self._same_scans = Pose2(), 0.0, 0
        self._view: Optional[_View] = None
        self._farthest = 0.0
        self._blindness = self._sameness = ""
        self._wheels = WheelMonitor()

    def reset(self) -> None:
        """Time has jumped: what was heard is worthless."""
        self.__init__()  # type: ignore[misc]

    def add_scan(self, ranges: np.ndarray, range_min: float, range_max: float, span: float) -> None:
        """A scan has come; ``ranges``: (N,), metres; ``span``: the angle between its outer beams, radians."""
        self._blindness = self._why_blind(ranges, range_min, range_max, span)
        self._sameness = self._why_frozen(ranges)
        self._ranges = ranges

    def add_odometry(self, now: float, base_in_odom: Pose2, command: Twist2) -> None:
        """Where odometry believes the robot to be, and what the robot has been told to do."""
        is_told_to_move = abs(command.v) > FAST or abs(command.omega) > FAST
        if base_in_odom != self._base or not is_told_to_move:
            self._still_since = None
        elif self._still_since is None:
            self._still_since, self._scan_when_still = now, self._ranges
        self._base, self._odometry_at = base_in_odom, now
        self._wheels.add_odometry(now, base_in_odom, command)

    def fault(self, now: float) -> Optional[str]:
        """What cannot be trusted, and why, for people: "scan: all of its beams are NaN"; None if all can."""
        if self._odometry_at is not None and now - self._odometry_at > SILENCE:
            return f"odometry: none for {now - self._odometry_at:.1f} s"
        for reason in (self._blindness, self._sameness):
            if reason:
                return f"scan: {reason}"
        if self._odometry_is_stuck(now):
            return "odometry: it stands still while the robot is told to move and its scans change"
        return self._wheels.fault()

    def _why_blind(self, ranges: np.ndarray, range_min: float, range_max: float, span: float) -> str:
        if not len(ranges):
            return "it has no beams"
        with np.errstate(invalid="ignore"):
            counts = {
                "NaN": np.count_nonzero(np.isnan(ranges)),
                f"nearer than {range_min:g} m": np.count_nonzero(ranges < max(range_min, 1e-3)),
            }
            seen = ranges[(ranges >= range_min) & (ranges < range_max)]
        looks_around = abs(span) > ALL_AROUND
        for what, count in counts.items():
            if count / len(ranges) >= NEARLY_ALL and looks_around:
                return f"nearly all of its beams are {what}"
        if len(seen) >= ENOUGH * len(ranges):
            self._view = _View(self._base, NOT_FAR if looks_around else self._room(seen, range_min))
        elif len(seen) <= (1.0 - NEARLY_ALL) * len(ranges) and self._view is not None:
            moved = self._view.base.inverse() @ self._base
            gone = math.hypot(moved.x, moved.y)
            is_same_view = looks_around or abs(moved.yaw) < SAME_VIEW * abs(span)
            if gone < self._view.room and is_same_view:
                return f"it has lost sight of everything within {gone:.1f} m"
        return ""

    def _room(self, seen: np.ndarray, range_min: float) -> float:
        """Metres by which half of what is seen may come nearer or go away and still be seen."""
        self._farthest = max(self._farthest, float(seen.max()))
        inside = np.minimum(seen - range_min, self._farthest - seen)
        return min(NOT_FAR, float(np.median(inside)))

    def _why_frozen(self, ranges: np.ndarray) -> str:
        """A single jump of odometry between two scans is none of the robot's motion."""
        moved = self._base_at_scan.inverse() @ self._base
        way, self._base_at_scan = max(math.hypot(moved.x, moved.y), abs(moved.yaw)), self._base
        is_same = self._ranges is not None and np.array_equal(ranges, self._ranges, equal_nan=True)
        if not is_same or not np.isfinite(ranges).any():
            self._same_way, self._same_scans = 0.0, 0
        elif way > LEAST_STEP:
            self._same_way, self._same_scans = self._same_way + way, self._same_scans + 1
        is_frozen = self._same_way >= NOTICEABLE and self._same_scans >= ENOUGH_SCANS
        return "it stays the same to the last bit while the robot moves" if is_frozen else ""

    def _odometry_is_stuck(self, now: float) -> bool:
        before, after = self._scan_when_still, self._ranges
        if self._still_since is None or now - self._still_since < PATIENCE:
            return False
        if before is None or after is None or len(before) != len(after):
            return False
        both = np.isfinite(before) & np.isfinite(after)
        return bool(both.any()) and float(np.median(np.abs(after[both] - before[both]))) > CHANGED
