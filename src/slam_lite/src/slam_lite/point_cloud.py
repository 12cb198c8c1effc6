"""Point clouds: the points of scans with surface normals, the form in which scans are matched and stored."""

import math
from dataclasses import dataclass
from typing import Iterable, Tuple

import numba
import numpy as np

from planar import Pose2, Scan

# Largest distance between neighbours on one straight wall [m], their largest distance from each other's line
# [m], and the least cosine between the lines.
_MAX_CHORD, _ON_LINE, _PARALLEL = 12.0, 0.1, 0.98


@dataclass(frozen=True, eq=False)
class PointCloud:
    """Points of one scan, in the base frame.

    Attributes:
        points_xy: float32 (N, 2), downsampled to an even spacing [m].
        normals_xy: float32 (N, 2), unit normal of the line through each point's neighbours, towards the
            laser; (0, 0) where the neighbours do not form a line.
    """

    points_xy: np.ndarray
    normals_xy: np.ndarray

    def __len__(self) -> int:
        return len(self.points_xy)


def point_cloud_of(scan: Scan, usable_range: float, spacing: float) -> PointCloud:
    """Convert a scan to points with normals.

    Args:
        scan: The scan.
        usable_range: Range above which readings are dropped [m].
        spacing: Least distance between consecutive points [m].
    """
    mount = scan.laser_in_base
    angle_sign = -1.0 if scan.upside_down else 1.0
    points_xy, normals_xy = _points_and_normals(
        scan.ranges,
        mount.yaw + angle_sign * scan.angle_min,
        angle_sign * scan.angle_increment,
        max(scan.range_min, 1e-3),
        min(usable_range, scan.range_max),
        mount.x,
        mount.y,
        spacing,
    )
    return PointCloud(points_xy, normals_xy)


def without_far_points(cloud: PointCloud, laser_xy: np.ndarray, max_range: float) -> PointCloud:
    """Drop the points beyond a range [m] from the laser (2,); returns ``cloud`` itself if there are none."""
    kept = np.hypot(*(cloud.points_xy - laser_xy).T) <= max_range
    return cloud if kept.all() else PointCloud(cloud.points_xy[kept], cloud.normals_xy[kept])


def merge_clouds(parts: Iterable[Tuple[PointCloud, Pose2]]) -> PointCloud:
    """Merge clouds.

    Args:
        parts: Clouds in their base frames, each with the pose of its base in a common frame.

    Returns:
        Cloud in the common frame.
    """
    parts = list(parts)
    points = np.empty((sum(len(cloud) for cloud, _ in parts), 2), dtype=np.float32)
    normals, end = np.empty_like(points), 0
    for cloud, pose in parts:
        here, end = end, end + len(cloud)
        _transform(
            cloud.points_xy, cloud.normals_xy, pose.x, pose.y, pose.yaw, points[here:end], normals[here:end]
        )
    return PointCloud(points, normals)


@numba.njit(cache=True, nogil=True)
def _transform(points, normals, x, y, yaw, new_points, new_normals):
    """Transform points and normals (N, 2) into the parent frame of a pose."""
    c, s = math.cos(yaw), math.sin(yaw)
    for i in range(len(points)):
        new_points[i, 0] = x + c * points[i, 0] - s * points[i, 1]
        new_points[i, 1] = y + s * points[i, 0] + c * points[i, 1]
        new_normals[i, 0] = c * normals[i, 0] - s * normals[i, 1]
        new_normals[i, 1] = s * normals[i, 0] + c * normals[i, 1]


def downsampled(cloud: PointCloud, count: int) -> PointCloud:
    """Reduce a cloud to every n-th point.

    Args:
        cloud: Cloud to reduce.
        count: Approximate number of points to keep; smaller clouds keep all.
    """
    step = max(1, len(cloud) // count)
    return PointCloud(
        np.ascontiguousarray(cloud.points_xy[::step]), np.ascontiguousarray(cloud.normals_xy[::step])
    )


def interpolated(cloud: PointCloud, spacing: float) -> PointCloud:
    """Add points between neighbours on the same line.

    The points on a distant wall have gaps, which move with the robot, although the wall has none.

    Args:
        cloud: Points of one scan, in order of the beams.
        spacing: Distance between added points [m].
    """
    points_xy, normals_xy = _interpolated(cloud.points_xy, cloud.normals_xy, spacing)
    return PointCloud(points_xy, normals_xy)


@numba.njit(cache=True, nogil=True)
def _interpolated(points, normals, spacing):
    counts = np.zeros(len(points), dtype=np.int64)
    for i in range(len(points) - 1):
        step = points[i + 1] - points[i]
        length = math.hypot(step[0], step[1])
        off = max(abs(_dot(step, normals[i])), abs(_dot(step, normals[i + 1])))
        if _dot(normals[i], normals[i + 1]) > _PARALLEL and length < _MAX_CHORD and off < _ON_LINE:
            counts[i] = int(length / spacing)
    dense = np.empty((len(points) + counts.sum(), 2), dtype=np.float32)
    dense_normals = np.empty_like(dense)
    at = 0
    for i in range(len(points)):
        for k in range(counts[i] + 1):
            dense[at], dense_normals[at] = points[i], normals[i]
            if k > 0:
                dense[at] += k / (counts[i] + 1) * (points[i + 1] - points[i])
            at += 1
    return dense, dense_normals


@numba.njit(cache=True, nogil=True)
def _dot(one, other):
    return one[0] * other[0] + one[1] * other[1]


@numba.njit(cache=True, nogil=True)
def _points_and_normals(ranges, angle, increment, shortest, longest, x, y, spacing):
    points = np.empty((ranges.size, 2), dtype=np.float32)
    count = 0
    for i in range(ranges.size):
        reading = ranges[i]
        if not shortest <= reading < longest:
            continue
        px = x + reading * math.cos(angle + i * increment)
        py = y + reading * math.sin(angle + i * increment)
        if count == 0 or math.hypot(px - points[count - 1, 0], py - points[count - 1, 1]) >= spacing:
            points[count, 0], points[count, 1] = px, py
            count += 1
    points = points[:count].copy()
    normals = np.zeros((count, 2), dtype=np.float32)
    for i in range(count):
        _set_normal(points, normals, i)
        if normals[i, 0] * (x - points[i, 0]) + normals[i, 1] * (y - points[i, 1]) < 0.0:
            normals[i] = -normals[i]
    return points, normals


@numba.njit(cache=True, nogil=True)
def _set_normal(points, normals, i):
    """Compute the normal to the principal axis of a point's neighbours.

    The neighbours are three points on each side and further ones within 0.2 m, none past a gap. If gaps leave
    none, the point may lie on a wall seen at a grazing angle: then the chord of the next points is used.
    """
    n, sx, sy, sxx, syy, sxy = 1, 0.0, 0.0, 0.0, 0.0, 0.0
    for side in (-1, 1):
        j = i + side
        while 0 <= j < len(points):
            dx, dy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
            distance = math.hypot(dx, dy)
            if distance > 0.5 or (abs(j - i) > 3 and distance > 0.2):
                break
            n, sx, sy = n + 1, sx + dx, sy + dy
            sxx, syy, sxy = sxx + dx * dx, syy + dy * dy, sxy + dx * dy
            j += side
    if n < 3:
        _set_normal_from_chord(points, normals, i)
        return
    cxx, cyy, cxy = sxx / n - (sx / n) ** 2, syy / n - (sy / n) ** 2, sxy / n - sx * sy / n**2
    middle, half = 0.5 * (cxx + cyy), math.hypot(0.5 * (cxx - cyy), cxy)
    if middle - half < 0.1 * (middle + half):
        direction = 0.5 * math.atan2(2.0 * cxy, cxx - cyy)
        normals[i, 0], normals[i, 1] = -math.sin(direction), math.cos(direction)


@numba.njit(cache=True, nogil=True)
def _set_normal_from_chord(points, normals, i):
    if not 0 < i < len(points) - 1:
        return
    dx, dy = points[i + 1, 0] - points[i - 1, 0], points[i + 1, 1] - points[i - 1, 1]
    length = math.hypot(dx, dy)
    if not 0.0 < length < 12.0:
        return
    nx, ny = -dy / length, dx / length
    if abs(nx * (points[i, 0] - points[i - 1, 0]) + ny * (points[i, 1] - points[i - 1, 1])) < 0.05:
        normals[i, 0], normals[i, 1] = nx, ny
