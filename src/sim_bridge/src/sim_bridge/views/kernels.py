"""Numba kernels of ray casting and rasterization; imported late, since importing numba takes long."""

import math

import numba
import numpy as np


@numba.njit(cache=True)
def _is_out_of_range(a, b, max_range):
    """Return whether the coordinates of both ends of a segment are beyond the range on the same side."""
    return min(a, b) > max_range or max(a, b) < -max_range


@numba.njit(cache=True)
def cast_rays(segments, x, y, first, increment, count, max_range):
    """Cast beams at segments: each segment is intersected with the beams between its two ends.

    Args:
        segments: Segments (N, 4) as x, y, x, y [m].
        x: Position of the sensor [m].
        y: Position of the sensor [m].
        first: Direction of the first beam [rad].
        increment: Angle between two beams [rad], positive.
        count: Number of beams.
        max_range: Largest range [m].

    Returns:
        Distances (count,) [m], infinite without a hit, and indices (count,) of the hit segments, else -1.
    """
    turn = 2.0 * math.pi
    first = (first + math.pi) % turn - math.pi
    ranges, nearest = np.full(count, np.inf), np.full(count, -1)
    # The direction of each beam, since most beams meet several segments.
    cosines, sines = np.empty(count), np.empty(count)
    c, s, c_next, s_next = math.cos(first), math.sin(first), math.cos(increment), math.sin(increment)
    for beam in range(count):
        cosines[beam], sines[beam] = c, s
        c, s = c * c_next - s * s_next, s * c_next + c * s_next
    beams_per_radian = 1.0 / increment
    # Most segments begin where the one before ends.
    end_x, end_y, end_bearing = math.inf, math.inf, 0.0
    for i in range(segments.shape[0]):
        ax, ay = segments[i, 0] - x, segments[i, 1] - y
        bx, by = segments[i, 2] - x, segments[i, 3] - y
        if _is_out_of_range(ax, bx, max_range) or _is_out_of_range(ay, by, max_range):
            continue
        side_x, side_y = bx - ax, by - ay
        area = ax * side_y - ay * side_x
        begin_bearing = end_bearing if ax == end_x and ay == end_y else math.atan2(ay, ax)
        end_x, end_y, end_bearing = bx, by, math.atan2(by, bx)
        # Seen from the sensor, the segment runs counter-clockwise from its right end to its left end.
        right = begin_bearing if area > 0.0 else end_bearing
        span = abs(end_bearing - begin_bearing)
        span = min(span, turn - span)
        start = right - first if right >= first else right - first + turn
        for shift in (0.0, turn):
            low = max(math.ceil((start - shift) * beams_per_radian - 1e-9), 0)
            high = min(math.floor((start + span - shift) * beams_per_radian + 1e-9), count - 1)
            for beam in range(low, high + 1):
                across = cosines[beam] * side_y - sines[beam] * side_x
                if across != 0.0:
                    distance = area / across
                    if 0.0 <= distance <= max_range and distance < ranges[beam]:
                        ranges[beam], nearest[beam] = distance, i
    return ranges, nearest


@numba.njit(cache=True)
def measure_ranges(
    true_ranges,
    sigma,
    draws,
    chance,
    dropouts,
    max_readings,
    below_min,
    no_return,
    nearest,
    max_range,
    farthest,
):
    """Return the measured ranges (count,), float32: true ranges with noise, limits and random failures.

    Args:
        true_ranges: Distance (count,) along each beam, infinite without a hit [m].
        sigma: Standard deviation of a range [m].
        draws: Standard normal random numbers (count,).
        chance: Uniform random numbers (count,), 0 to 1; empty for no failures.
        dropouts: Fraction of the beams without a return.
        max_readings: Fraction of the beams that read ``farthest``.
        below_min: Reading of a beam with a range below ``nearest``.
        no_return: Reading of a beam without a return.
        nearest: Smallest range [m].
        max_range: Largest range [m].
        farthest: Reading of a failed beam [m].
    """
    measured = np.empty(true_ranges.size, dtype=np.float32)
    for beam in range(true_ranges.size):
        value = true_ranges[beam] + sigma * draws[beam]
        if value < nearest:
            value = below_min
        if value > max_range:
            value = no_return
        if chance.size > 0 and chance[beam] < dropouts:
            value = no_return
        if chance.size > 0 and chance[beam] > 1.0 - max_readings:
            value = farthest
        measured[beam] = value
    return measured


@numba.njit(cache=True)
def rasterize(triangles, colours, scale, centre_x, centre_y, near, far, perspective, image, depth):
    """Clip each triangle at the near plane and fill the remaining polygon as a fan.

    Args:
        triangles: Triangles (T, 3, 3) in the optical frame [m].
        colours: Their colours (T, 3), uint8.
        scale: Pixels per metre, at 1 m distance if ``perspective``.
        centre_x: Column of the optical axis [pixels].
        centre_y: Row of the optical axis [pixels].
        near: Nearest visible depth [m].
        far: Farthest visible depth [m].
        perspective: Whether x and y are divided by z.
        image: Image (H, W, 3), uint8, changed in place.
        depth: Depth image (H, W), float32 [m], changed in place; pixels that are nearer are kept.
    """
    corners = np.empty((4, 3))
    for t in range(triangles.shape[0]):
        count = 0
        for i in range(3):
            a, b = triangles[t, i], triangles[t, (i + 1) % 3]
            if a[2] >= near:
                corners[count] = a
                count += 1
            if (a[2] >= near) != (b[2] >= near):
                share = (near - a[2]) / (b[2] - a[2])
                corners[count] = a + share * (b - a)
                count += 1
        if count < 3:
            continue
        for i in range(count):
            factor = scale / corners[i, 2] if perspective else scale
            corners[i, 0] = corners[i, 0] * factor + centre_x
            corners[i, 1] = corners[i, 1] * factor + centre_y
            if perspective:
                corners[i, 2] = 1.0 / corners[i, 2]
        for i in range(1, count - 1):
            _fill(corners[0], corners[i], corners[i + 1], colours[t], far, perspective, image, depth)


@numba.njit(cache=True)
def _fill(a, b, c, colour, far, perspective, image, depth):
    """Fill the pixels whose centre is in a triangle; 1 / z (z, without perspective) is linear there."""
    height, width = depth.shape
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    if area == 0.0:
        return
    top = max(int(np.ceil(min(a[1], b[1], c[1]))), 0)
    bottom = min(int(np.floor(max(a[1], b[1], c[1]))), height - 1)
    left = max(int(np.ceil(min(a[0], b[0], c[0]))), 0)
    right = min(int(np.floor(max(a[0], b[0], c[0]))), width - 1)
    for row in range(top, bottom + 1):
        for col in range(left, right + 1):
            of_a = ((b[0] - col) * (c[1] - row) - (b[1] - row) * (c[0] - col)) / area
            of_b = ((c[0] - col) * (a[1] - row) - (c[1] - row) * (a[0] - col)) / area
            of_c = 1.0 - of_a - of_b
            if of_a < 0.0 or of_b < 0.0 or of_c < 0.0:
                continue
            value = of_a * a[2] + of_b * b[2] + of_c * c[2]
            z = 1.0 / value if perspective else value
            if z < depth[row, col] and z <= far:
                depth[row, col] = z
                image[row, col, 0] = colour[0]
                image[row, col, 1] = colour[1]
                image[row, col, 2] = colour[2]
