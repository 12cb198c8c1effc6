"""The beams of a scan that the sensor model looks at."""

import math
from dataclasses import dataclass
from functools import cached_property

import numba
import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.errors import LocalizationError
from planar import Scan

_MANY = 400


@dataclass(frozen=True, eq=False)
class Beams:
    """Some beams of one scan in the base frame.

    ``ranges``: (N,), metres, ``max_range`` where nothing was met. ``directions``: (N,), radians.
    ``start_xy``: (2,), where the laser sits in the base frame. ``unmeasured``: how many more were looked at
    and left out, being NaN.
    """

    ranges: np.ndarray
    directions: np.ndarray
    max_range: float
    start_xy: np.ndarray
    unmeasured: int = 0

    @cached_property
    def ends_xy(self) -> np.ndarray:
        """Where the beams that met something end: (M, 2), in the base frame."""
        return _ends(self.ranges, self.directions, self.max_range, self.start_xy)


def all_beams(scan: Scan, settings: LocalizerSettings) -> Beams:
    """The beams of a scan, every so manyth if there are very many; else as ``evenly_spaced_beams``."""
    return _beams(scan, settings, max(1, len(scan.ranges) // _MANY))


def evenly_spaced_beams(scan: Scan, settings: LocalizerSettings) -> Beams:
    """About ``settings.beams`` beams of a scan; those without a measurement (NaN) are left out.

    Readings up to the least range mean "no return" (amcl), as do +inf and those beyond the largest range.
    Raises LocalizationError if the scan's limits make no sense.
    """
    return _beams(scan, settings, _step(len(scan.ranges), settings))


def _beams(scan: Scan, settings: LocalizerSettings, step: int) -> Beams:
    max_range, min_range = float(scan.range_max), float(scan.range_min)
    if settings.laser_max_range > 0.0:
        max_range = min(max_range, settings.laser_max_range)
    if settings.laser_min_range > 0.0:
        min_range = max(min_range, settings.laser_min_range)
    if not (max_range > 0.0 and min_range >= 0.0 and np.isfinite(max_range)):
        raise LocalizationError(f"a scan has senseless limits: range_min {min_range}, range_max {max_range}")
    sign = -1.0 if scan.upside_down else 1.0
    sweep = (sign * scan.angle_min, sign * scan.angle_increment, scan.laser_in_base.yaw)
    ranges, directions = _measured(scan.ranges.astype(np.float64), step, sweep, min_range, max_range)
    start_xy = np.array([scan.laser_in_base.x, scan.laser_in_base.y])
    return Beams(ranges, directions, max_range, start_xy, -(-len(scan.ranges) // step) - len(ranges))


def _step(count: int, settings: LocalizerSettings) -> int:
    """amcl's steps from one used beam to the next; they differ from model to model."""
    if settings.sensor_model == "likelihood_field_prob":
        return max(1, -(-count // max(1, settings.beams)))
    return max(1, (count - 1) // max(1, settings.beams - 1))


@numba.njit(cache=True)
def _measured(ranges, step, sweep, min_range, max_range):
    """Every so manyth range and its direction, if it is not NaN; ``max_range`` for those out of limits.

    ``sweep``: the first angle, from one beam to the next, and how the laser is turned in the base frame.
    """
    most, count = -(-ranges.size // step), 0
    kept, directions = np.empty(most), np.empty(most)
    first, increment, turned = sweep
    for i in range(0, ranges.size, step):
        told = ranges[i]
        if not math.isnan(told):
            kept[count] = told if min_range < told <= max_range else max_range
            directions[count] = first + increment * i + turned
            count += 1
    return kept[:count], directions[:count]


@numba.njit(cache=True)
def _ends(ranges, directions, max_range, start_xy):
    """Where those shorter than ``max_range`` end: (M, 2)."""
    ends_xy, count = np.empty((ranges.size, 2)), 0
    for i in range(ranges.size):
        if ranges[i] < max_range:
            ends_xy[count, 0] = start_xy[0] + ranges[i] * math.cos(directions[i])
            ends_xy[count, 1] = start_xy[1] + ranges[i] * math.sin(directions[i])
            count += 1
    return ends_xy[:count]
