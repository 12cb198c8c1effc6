"""The beams of a scan that the sensor model uses."""

import math

import numba
import numpy as np

from amcl_lite.config import LocalizerSettings
from amcl_lite.errors import LocalizationError
from amcl_lite.sensor.custom_model import Beams
from planar import Scan

_MANY = 400


def all_beams(scan: Scan, settings: LocalizerSettings) -> Beams:
    """Select all beams of a scan, thinned to about _MANY; otherwise as ``evenly_spaced_beams``."""
    return _beams(scan, settings, max(1, len(scan.ranges) // _MANY))


def evenly_spaced_beams(scan: Scan, settings: LocalizerSettings) -> Beams:
    """Select about ``settings.beams`` evenly spaced beams of a scan; NaN ranges are dropped.

    Ranges up to the minimum, above the maximum, and +inf mean "no return", as in amcl.

    Raises:
        LocalizationError: If the limits of the scan are invalid.
    """
    return _beams(scan, settings, _step(len(scan.ranges), settings))


def _beams(scan: Scan, settings: LocalizerSettings, step: int) -> Beams:
    max_range, min_range = float(scan.range_max), float(scan.range_min)
    if settings.laser_max_range > 0.0:
        max_range = min(max_range, settings.laser_max_range)
    if settings.laser_min_range > 0.0:
        min_range = max(min_range, settings.laser_min_range)
    if not (max_range > 0.0 and min_range >= 0.0 and np.isfinite(max_range)):
        raise LocalizationError(f"invalid limits of a scan: range_min {min_range}, range_max {max_range}")
    sign = -1.0 if scan.upside_down else 1.0
    sweep = (sign * scan.angle_min, sign * scan.angle_increment, scan.laser_in_base.yaw)
    ranges, directions = _measured(scan.ranges.astype(np.float64), step, sweep, min_range, max_range)
    start_xy = np.array([scan.laser_in_base.x, scan.laser_in_base.y])
    return Beams(ranges, directions, max_range, start_xy, -(-len(scan.ranges) // step) - len(ranges))


def _step(count: int, settings: LocalizerSettings) -> int:
    """Return amcl's step between used beams, which depends on the sensor model."""
    if settings.sensor_model == "likelihood_field_prob":
        return max(1, -(-count // max(1, settings.beams)))
    return max(1, (count - 1) // max(1, settings.beams - 1))


@numba.njit(cache=True)
def _measured(ranges, step, sweep, min_range, max_range):
    """Return every ``step``-th range that is not NaN and its direction; ``max_range`` out of limits.

    ``sweep`` is (first angle, increment, yaw of the laser in the base frame).
    """
    most, count = -(-ranges.size // step), 0
    kept, directions = np.empty(most), np.empty(most)
    first, increment, turned = sweep
    for i in range(0, ranges.size, step):
        value = ranges[i]
        if not math.isnan(value):
            kept[count] = value if min_range < value <= max_range else max_range
            directions[count] = first + increment * i + turned
            count += 1
    return kept[:count], directions[:count]
