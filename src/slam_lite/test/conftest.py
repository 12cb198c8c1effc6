"""A simulated office, and a robot that drives through it with a laser and drifting odometry."""

import math
from typing import List, NamedTuple

import numpy as np
import pytest

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, Scan
from planar.geometry.ray_casting import cast_rays

RESOLUTION = 0.05
CORRIDOR = [(2.0, 2.0), (14.0, 2.0), (14.0, 9.0), (2.0, 9.0), (2.0, 2.0)]
SPEED, PERIOD = 0.5, 0.25


class Observation(NamedTuple):
    """A scan, odometry, and the true pose in the map frame."""

    scan: Scan
    base_in_odom: Pose2
    base_in_map: Pose2


class Office(NamedTuple):
    """The true grid, and the laser and drives in it."""

    truth: OccupancyGrid

    def scan(self, base_in_map: Pose2, stamp=0.0, beams=181, field_of_view=math.pi, range_max=20.0, rng=None):
        angles = np.linspace(-field_of_view / 2.0, field_of_view / 2.0, beams)
        ranges = cast_rays(self.truth, base_in_map, angles, 2.0 * range_max)
        if rng is not None:
            ranges = ranges + rng.normal(0.0, 0.01, beams)
        ranges[ranges > range_max] = np.inf
        return Scan(stamp, angles[0], angles[1] - angles[0], ranges.astype(np.float32), 0.1, range_max)

    def drive(self, laps=1.2, seed=0, turn_error=0.03, **laser) -> List[Observation]:
        rng = np.random.default_rng(seed)
        observations, base_in_odom, last = [], Pose2(), None
        for i, base_in_map in enumerate(_route(laps)):
            if last is not None:
                motion = last.inverse() @ base_in_map
                slip = rng.normal(0.0, 0.01, 2)
                base_in_odom = base_in_odom @ Pose2(
                    motion.x * (1.03 + slip[0]), motion.y, motion.yaw * (1.0 + turn_error) + 0.2 * slip[1]
                )
            last = base_in_map
            scan = self.scan(base_in_map, i * PERIOD, rng=rng, **laser)
            observations.append(Observation(scan, base_in_odom, base_in_map))
        start = observations[0].base_in_map
        return [s._replace(base_in_odom=start @ s.base_in_odom) for s in observations]


@pytest.fixture(scope="session")
def office() -> Office:
    """16 m x 11 m: a ring of corridors with niches and rooms of different sizes; every place is unique."""
    cells = np.full((round(11.0 / RESOLUTION), round(16.0 / RESOLUTION)), OCCUPIED, dtype=np.int8)

    def fill(value, *box):
        left, low, right, high = (round(edge / RESOLUTION) for edge in box)
        cells[low:high, left:right] = value

    for box in ((1, 1, 15, 3), (1, 8, 15, 10), (1, 1, 3, 10), (13, 1, 15, 10)):
        fill(FREE, *box)
    for box in ((4.0, 3.0, 4.9, 3.4), (6.2, 3.0, 9.0, 5.0), (10.5, 3.0, 11.4, 3.3), (3.0, 4.2, 3.4, 5.2)):
        fill(FREE, *box)
    for box in ((3.0, 6.1, 5.0, 7.0), (6.0, 7.6, 7.0, 8.0), (8.3, 6.5, 11.5, 8.0), (12.6, 5.0, 13.0, 6.4)):
        fill(FREE, *box)
    fill(OCCUPIED, 7.2, 4.0, 7.6, 4.4)
    return Office(OccupancyGrid(cells, RESOLUTION))


def _route(laps):
    corners = [np.array(corner) for corner in CORRIDOR]
    legs = round(4 * laps)
    for leg in range(legs):
        start, end = corners[leg % 4], corners[leg % 4 + 1]
        heading = math.atan2(*(end - start)[::-1])
        for t in np.arange(0.0, 1.0, SPEED * PERIOD / np.linalg.norm(end - start)):
            yield Pose2(*(start + t * (end - start)), heading)
        for turn in np.linspace(0.0, math.pi / 2.0, 9)[:-1]:
            yield Pose2(*end, heading + turn)
