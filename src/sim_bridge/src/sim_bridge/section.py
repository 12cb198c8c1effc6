"""The outlines of a world's bodies at one height, and beams cast at them."""

import math
from typing import Callable, List, Tuple

import numba
import numpy as np

from sim_bridge.slicing import cut
from sim_bridge.world import Body

# Metres or radians of movement below which an outline is not drawn anew.
STILL = 1e-6


class Section:
    """A level cut through the bodies of a world that follows those that move."""

    def __init__(self, height: float):
        self._height = height
        self._still = np.empty((0, 4))
        self._moving: List[Tuple[Body, np.ndarray, np.ndarray]] = []

    def add(self, body: Body) -> None:
        segments = self._segments_of(body, body.pose_in_world)
        if body.mass is None:
            self._still = np.vstack((self._still, segments))
        else:
            self._moving.append((body, body.pose_in_world, segments))

    def segments(self, pose_of: Callable[[str], np.ndarray]) -> np.ndarray:
        """Sides (N, 4) of all outlines as x, y, x, y; ``pose_of`` says where a body is now, (4, 4)."""
        for index, (body, drawn_at, _) in enumerate(self._moving):
            pose = pose_of(body.name)
            if not np.allclose(pose, drawn_at, rtol=0.0, atol=STILL):
                self._moving[index] = (body, pose, self._segments_of(body, pose))
        return np.vstack([self._still, *(segments for _, _, segments in self._moving)])

    def _segments_of(self, body: Body, pose: np.ndarray) -> np.ndarray:
        sides = [
            np.hstack((outline, np.roll(outline, -1, axis=0)))
            for part in body.collisions
            for outline in cut(part.shape, pose @ part.pose_in_body, self._height, self._height)
        ]
        return np.vstack(sides) if sides else np.empty((0, 4))


def cast_beams(
    segments: np.ndarray, x: float, y: float, first: float, increment: float, count: int, sight: float
) -> np.ndarray:
    """Distance, metres, from (x, y) to the nearest segment along each of ``count`` beams.

    ``segments``: (N, 4) as x, y, x, y. Beam i points along ``first + i * increment``, radians, increment
    positive. Returns (count,); infinite where nothing lies within ``sight`` metres.
    """
    return _cast(np.ascontiguousarray(segments), x, y, first, increment, count, sight)


@numba.njit(cache=True)
def _cast(segments, x, y, first, increment, count, sight):
    """Walks through the segments and gives each to the beams between the bearings of its two ends."""
    turn = 2.0 * math.pi
    ranges = np.full(count, np.inf)
    for i in range(segments.shape[0]):
        ax, ay = segments[i, 0] - x, segments[i, 1] - y
        bx, by = segments[i, 2] - x, segments[i, 3] - y
        if min(ax, bx) > sight or max(ax, bx) < -sight or min(ay, by) > sight or max(ay, by) < -sight:
            continue
        side_x, side_y = bx - ax, by - ay
        area = ax * side_y - ay * side_x
        # Seen from here the segment runs counter-clockwise from its right end to its left end.
        right = math.atan2(ay, ax) if area > 0.0 else math.atan2(by, bx)
        span = math.atan2(abs(area), ax * bx + ay * by)
        start = (right - first) % turn
        for shift in (0.0, turn):
            low = max(math.ceil((start - shift) / increment - 1e-9), 0)
            high = min(math.floor((start + span - shift) / increment + 1e-9), count - 1)
            for beam in range(low, high + 1):
                angle = first + beam * increment
                across = math.cos(angle) * side_y - math.sin(angle) * side_x
                if across != 0.0:
                    distance = area / across
                    if 0.0 <= distance <= sight and distance < ranges[beam]:
                        ranges[beam] = distance
    return ranges
