"""Planar laser scans."""

import math
from dataclasses import dataclass, field

import numpy as np

from planar.errors import OutOfRangeError
from planar.geometry.limits import MAX_ANGLE, MAX_BEAMS, MAX_COORDINATE, check_within
from planar.geometry.pose import Pose2


@dataclass(frozen=True, eq=False)
class Scan:
    """One sweep of a planar range finder, with the semantics of sensor_msgs/LaserScan (REP 117).

    Attributes:
        stamp: Time of the first ray [s].
        angle_min: Direction of the first ray in the laser frame [rad].
        angle_increment: Angle between rays [rad].
        ranges: Ranges [m], float32 or float64 (N,); +inf means nothing within range_max, NaN no measurement.
        range_min: Smallest valid range [m].
        range_max: Largest range [m].
        laser_in_base: Pose of the laser on the robot.
        upside_down: Whether the laser's z axis points down, which makes its angles clockwise in the base
            frame.
        intensities: Intensities, float32 (N,), any unit; empty if the sensor has none.

    Raises:
        OutOfRangeError: For values that no laser measures.
    """

    stamp: float
    angle_min: float
    angle_increment: float
    ranges: np.ndarray
    range_min: float
    range_max: float
    laser_in_base: Pose2 = field(default_factory=Pose2)
    upside_down: bool = False
    intensities: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=np.float32))

    def __post_init__(self):
        if np.ndim(self.ranges) != 1 or len(self.ranges) > MAX_BEAMS:
            raise OutOfRangeError(f"invalid scan of {np.size(self.ranges)} ranges")
        last, step = self.angle_min + self.angle_increment * len(self.ranges), self.angle_increment
        check_within(MAX_ANGLE, "a scan", angle_min=self.angle_min, angle_increment=step, angle_max=last)
        check_within(MAX_COORDINATE, "a scan", range_min=self.range_min, range_max=self.range_max)
        if not (math.isfinite(self.stamp) and self.laser_in_base.is_in_range()):
            raise OutOfRangeError("a scan without a finite stamp or a valid pose")

    @property
    def angles(self) -> np.ndarray:
        """Beam directions (N,) in the laser frame seen from above (mirrored if upside down) [rad]."""
        return self.angles_of(np.arange(len(self.ranges)))

    def angles_of(self, beams: np.ndarray) -> np.ndarray:
        """Return the directions of the beams with these indices (M,), as ``angles``."""
        angles = self.angle_min + self.angle_increment * beams
        return -angles if self.upside_down else angles

    @property
    def hits(self) -> np.ndarray:
        """Which beams hit something, bool (N,): finite and range_min <= r < range_max."""
        with np.errstate(invalid="ignore"):
            return np.isfinite(self.ranges) & (self.ranges >= self.range_min) & (self.ranges < self.range_max)

    def hit_points_in_base(self) -> np.ndarray:
        """Return the end points of the beams that hit something in the base frame [m], (M, 2)."""
        hits = self.hits
        ranges, angles = self.ranges[hits].astype(np.float64), self.angles[hits]
        points_in_laser = np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles)))
        return self.laser_in_base.transform_points(points_in_laser)
