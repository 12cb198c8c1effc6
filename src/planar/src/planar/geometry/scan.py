"""Planar laser scans."""

import math
from dataclasses import dataclass, field

import numpy as np

from planar.geometry.limits import MAX_ANGLE, MAX_BEAMS, MAX_COORDINATE, OutOfRangeError, check_within
from planar.geometry.pose import Pose2


@dataclass(frozen=True, eq=False)
class Scan:
    """One sweep of a planar range finder, with the meaning of sensor_msgs/LaserScan (REP 117).

    ``ranges``: float32 or float64 (N,), metres; +inf is "nothing within range_max", NaN "no measurement".
    ``stamp``: seconds, of the first ray. ``laser_in_base``: where the laser is mounted;
    ``upside_down``: the laser's z axis points down, so its angles count clockwise in the base frame.
    ``intensities``: float32 (N,), how much light came back, in any unit; empty if it cannot tell.

    Raises OutOfRangeError for what no laser measures: whoever has a scan may count on its numbers.
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
            raise OutOfRangeError(f"a scan of {np.size(self.ranges)} ranges means nothing")
        last, step = self.angle_min + self.angle_increment * len(self.ranges), self.angle_increment
        check_within(MAX_ANGLE, "a scan", angle_min=self.angle_min, angle_increment=step, angle_max=last)
        check_within(MAX_COORDINATE, "a scan", range_min=self.range_min, range_max=self.range_max)
        if not (math.isfinite(self.stamp) and self.laser_in_base.is_in_range()):
            raise OutOfRangeError("a scan without a finite stamp and place means nothing")

    @property
    def angles(self) -> np.ndarray:
        """Beam directions (N,) in the laser frame seen from above (already mirrored if upside down)."""
        return self.angles_of(np.arange(len(self.ranges)))

    def angles_of(self, beams: np.ndarray) -> np.ndarray:
        """The directions of some beams (M,) given by their numbers (M,), as ``angles``."""
        angles = self.angle_min + self.angle_increment * beams
        return -angles if self.upside_down else angles

    @property
    def hits(self) -> np.ndarray:
        """Which beams met something: bool (N,), finite and range_min <= r < range_max."""
        with np.errstate(invalid="ignore"):
            return np.isfinite(self.ranges) & (self.ranges >= self.range_min) & (self.ranges < self.range_max)

    def hit_points_in_base(self) -> np.ndarray:
        """End points (M, 2) of the beams that met something, in the base frame."""
        hits = self.hits
        ranges, angles = self.ranges[hits].astype(np.float64), self.angles[hits]
        points_in_laser = np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles)))
        return self.laser_in_base.transform_points(points_in_laser)
