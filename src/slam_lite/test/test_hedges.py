"""Loop closures between hedges, which beams partly pass, so that scans of them contradict each other."""

import math

import numpy as np
import pytest

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, Scan, wrap
from planar.geometry.ray_casting import cast_rays
from slam_lite.config import MapperSettings
from slam_lite.mapper import Mapper

# A path around a field, in metres, with hedges at both sides; the robot passes its start again.
WIDTH, DEPTH, MARGIN, RESOLUTION = 70.0, 40.0, 8.0, 0.1
STEP, AGAIN = 0.5, 40.0
BEAMS, RANGE_MAX, RANGE_NOISE = 180, 25.0, 0.015
LEAF_DEPTH = 0.12
# Drift of odometry [rad/m], of which scan matching along hedges corrects most.
DRIFT = 0.002


def hedges(rng, distance):
    """A grid with sections of hedges at both sides of the path, in metres from it."""
    rows, cols = (round((size + 2.0 * MARGIN) / RESOLUTION) for size in (DEPTH, WIDTH))
    cells = np.full((rows, cols), FREE, dtype=np.int8)
    for offset in (-distance, distance):
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * (0.5 * np.array([WIDTH, DEPTH]) + offset)
        for start, end in zip(corners, np.roll(corners, -1, axis=0)):
            direction = (end - start) / np.hypot(*(end - start))
            along = rng.uniform(0.0, 3.0)
            while along < np.hypot(*(end - start)) - 2.0:
                size = min(rng.uniform(3.0, 12.0), np.hypot(*(end - start)) - along)
                shift = rng.uniform(-0.6, 0.6) * np.array([-direction[1], direction[0]])
                fill(cells, start + along * direction + shift, start + (along + size) * direction + shift)
                along += size + rng.uniform(1.0, 5.0)
    return OccupancyGrid(cells, RESOLUTION, Pose2(-0.5 * WIDTH - MARGIN, -0.5 * DEPTH - MARGIN))


def fill(cells, start, end):
    corner = [0.5 * WIDTH + MARGIN, 0.5 * DEPTH + MARGIN]
    low, high = np.sort(np.array([start, end]) + corner, axis=0) / RESOLUTION
    (col, row), (end_col, end_row) = low.astype(int), high.astype(int) + 5
    cells[row:end_row, col:end_col] = OCCUPIED


def path():
    """Poses around the field, and on past the start; the robot turns at the corners."""
    sides = [WIDTH, DEPTH, WIDTH, DEPTH, AGAIN]
    pose = Pose2(-0.5 * WIDTH, -0.5 * DEPTH, 0.0)
    for number, length in enumerate(sides):
        for _ in range(round(length / STEP)):
            yield pose
            pose = pose @ Pose2(STEP, 0.0)
        for _ in range(4 if number < 4 else 0):
            pose = pose @ Pose2(0.0, 0.0, math.pi / 8.0)
            yield pose


def log(seed):
    """Odometry, scan and true pose, scan by scan."""
    rng = np.random.default_rng(seed)
    inner, outer = hedges(rng, 3.0), hedges(rng, 6.0)
    angles = np.linspace(-0.5 * math.pi, 0.5 * math.pi, BEAMS)
    in_odom, last = Pose2(), None
    for number, pose in enumerate(path()):
        motion = Pose2() if last is None else last.inverse() @ pose
        noise = rng.normal(0.0, 0.01 * math.hypot(motion.x, motion.y))
        turned = DRIFT * motion.x + rng.normal(0.0, 0.002)
        in_odom, last = in_odom @ motion @ Pose2(noise, 0.0, turned), pose
        readings = ranges(inner, outer, pose, angles, rng)
        scan = Scan(1.0 * number, angles[0], angles[1] - angles[0], readings, 0.1, 30.0)
        yield in_odom, scan, pose


def ranges(inner, outer, pose, angles, rng):
    """Beams pass the inner hedges with a probability from 0.3 to 0.7, which differs along them."""
    first, behind = (cast_rays(grid, pose, angles, 30.0) for grid in (inner, outer))
    x, y = pose.x + first * np.cos(pose.yaw + angles), pose.y + first * np.sin(pose.yaw + angles)
    passes = rng.random(BEAMS) < 0.5 + 0.2 * np.sin(0.7 * x + 1.3 * y)
    leaf = rng.exponential(LEAF_DEPTH, BEAMS) + rng.normal(0.0, RANGE_NOISE, BEAMS)
    found = np.where(passes | (first > behind), behind, first) + leaf
    return np.where(found < RANGE_MAX, found, 30.0).astype(np.float32)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_loop_between_hedges_is_closed(seed):
    mapper, true_keyframes = Mapper(MapperSettings()), []
    for in_odom, scan, pose in log(seed):
        update = mapper.insert(in_odom, scan)
        if update is not None and update.is_keyframe:
            true_keyframes.append(pose)
    edges = mapper.state().edges
    loops = [edges[number] for number in np.flatnonzero(edges.is_loop)]
    around = [loop for loop in loops if loop.second - loop.first > len(true_keyframes) // 2]
    assert len(around) >= 3
    for loop in around:
        true = true_keyframes[loop.first].inverse() @ true_keyframes[loop.second]
        off = loop.second_in_first.as_array() - true.as_array()
        off[2] = wrap(off[2])
        is_near = math.hypot(off[0], off[1]) < 0.5 and abs(off[2]) < 0.05
        # along a smooth section the information does not include the position
        assert is_near or off @ loop.information @ off < 16.0
