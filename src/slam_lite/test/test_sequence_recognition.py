"""A street of houses that is driven again, after a path without scans."""

import math

import numpy as np
import pytest

from planar import Pose2, wrap
from slam_lite.graph.pose_graph import Edge, edges_of
from slam_lite.loops.sequence_recognition import recognize_sequences
from slam_lite.loops.tracked_trajectory import tracked_trajectory
from slam_lite.point_cloud import PointCloud

KEYFRAMES, STEP, SIGHT = 250, 0.4, 15.0
FIRM, LOOSE = np.diag([100.0**2, 100.0**2, 1000.0**2]), np.diag([30.0**-2, 30.0**-2, 0.5**-2])
SLIPPERY, SEEN = np.diag([10.0**2, 10.0**2, 10.0**2]), np.diag([1.0, 1.0, 50.0**2])
STREET = [Pose2(STEP * i, 0.0, 0.0) for i in range(KEYFRAMES)]
# Wrong measurement from the end of the street back to its beginning.
MEASURED = Pose2(-80.0, 30.0, 0.6)


def houses(rng, period=0.0):
    """Rows x, y, length, depth of the houses on both sides, repeated after ``period`` metres if given."""
    rows = []
    for side in (-1.0, 1.0):
        x = -20.0
        while x < 120.0:
            length, depth, away, gap = rng.uniform((3.0, 3.0, 3.0, 1.5), (9.0, 8.0, 7.0, 6.0))
            rows.append((x, side * away, length, side * depth))
            x += length + gap
    rows = np.array(rows)
    if not period:
        return rows
    first = rows[(rows[:, 0] >= 0.0) & (rows[:, 0] < period)]
    return np.concatenate([first + [period * i, 0.0, 0.0, 0.0] for i in range(-2, 14)])


def walls(rows):
    """Points (N, 2) on all walls, and their normals (N, 2), outwards."""
    points, normals = [], []
    for x, y, length, depth in rows:
        corners = np.array([(x, y), (x + length, y), (x + length, y + depth), (x, y + depth)])
        middle = corners.mean(axis=0)
        for one, other in zip(corners, np.roll(corners, -1, axis=0)):
            count = round(math.dist(one, other) / 0.1)
            points.append(one + (other - one) * np.linspace(0.0, 1.0, count)[:, None])
            along = (other - one) / math.dist(one, other)
            normal = np.array([along[1], -along[0]])
            normals.append(np.tile(normal * np.sign(normal @ (one - middle)), (count, 1)))
    return np.concatenate(points), np.concatenate(normals)


def seen_from(pose, world, rng):
    points, normals = world
    toward = [pose.x, pose.y] - points
    seen = (np.hypot(*toward.T) < SIGHT) & ((toward * normals).sum(axis=1) > 0.0)
    seen &= rng.uniform(size=len(points)) < 0.2
    points = pose.inverse().transform_points(points[seen]) + rng.normal(0.0, 0.02, (seen.sum(), 2))
    return PointCloud(
        points.astype(np.float32),
        Pose2(0.0, 0.0, -pose.yaw).transform_points(normals[seen]).astype(np.float32),
    )


def steps_along(true, rng):
    """Measured edges from each pose to the next."""
    steps = [a.inverse() @ b @ Pose2(*rng.normal(0.0, (0.01, 0.01, 0.001))) for a, b in zip(true, true[1:])]
    return [Edge(i, i + 1, step, FIRM) for i, step in enumerate(steps)]


class Street:
    def __init__(self, seed, period=0.0, there_again=True, back=LOOSE):
        rng = np.random.default_rng(seed)
        world = walls(houses(rng, period))
        again = world if there_again else walls(houses(rng, period))
        self.true = 2 * STREET
        worlds = KEYFRAMES * [world] + KEYFRAMES * [again]
        self.clouds = [seen_from(pose, each, rng) for pose, each in zip(self.true, worlds)]
        steps = steps_along(self.true, rng)
        steps[KEYFRAMES - 1] = Edge(KEYFRAMES - 1, KEYFRAMES, MEASURED, back)
        self.edges = edges_of(*steps)
        self.trajectory = tracked_trajectory(np.zeros(3), self.edges)

    def recognized(self):
        return recognize_sequences(self.trajectory.poses, self.edges, self.clouds, self.trajectory)


def recognized_in_identical_streets(seed):
    """Two streets of the same houses, between them wheel slips without scans; one end sees the other."""
    rng = np.random.default_rng(seed)
    world = walls(houses(rng))
    empty = PointCloud(np.zeros((0, 2), dtype=np.float32), np.zeros((0, 2), dtype=np.float32))
    street, copy = ([seen_from(pose, world, rng) for pose in STREET] for _ in range(2))
    path = [Pose2(STREET[-1].x - share * 40.0, -share * 40.0, 0.0) for share in np.linspace(0.0, 1.0, 100)]
    true = [*STREET, *path[1:-1], *(path[-1] @ pose for pose in STREET)]
    steps = steps_along(true, rng)
    for i in range(KEYFRAMES - 1, len(true) - KEYFRAMES):
        steps[i] = Edge(i, i + 1, steps[i].second_in_first, SLIPPERY)
    ends = Edge(KEYFRAMES - 1, len(true) - 1, true[KEYFRAMES - 1].inverse() @ true[-1], SEEN, is_loop=True)
    edges = edges_of(*steps, ends)
    clouds = [*street, *(len(path) - 2) * [empty], *copy]
    poses = np.array([pose.as_array() for pose in true])
    return recognize_sequences(poses, edges, clouds, tracked_trajectory(np.zeros(3), edges))


@pytest.mark.parametrize("seed", [80, 81, 82])
def test_a_revisited_street_is_recognized(seed):
    street = Street(seed)
    found = street.recognized()
    assert len(found) >= 5
    for each in found:
        true = street.true[each.place].inverse() @ street.true[each.recent]
        assert each.place < KEYFRAMES <= each.recent
        assert each.recent_in_place.distance_to(true) < 1.0
        assert abs(wrap(each.recent_in_place.yaw - true.yaw)) < 0.05


@pytest.mark.parametrize("seed", [80, 81, 82])
def test_a_street_of_identical_houses_is_not_recognized(seed):
    assert Street(seed, period=12.0).recognized() == []


@pytest.mark.parametrize("seed", [80, 81, 82])
def test_another_street_is_not_recognized(seed):
    assert Street(seed, there_again=False).recognized() == []


def test_a_graph_with_little_covariance_rules_a_hypothesis_out():
    assert Street(80, back=FIRM).recognized() == []


@pytest.mark.parametrize("seed", [80, 81, 82])
def test_an_identical_street_elsewhere_is_not_recognized(seed):
    assert recognized_in_identical_streets(seed) == []


def test_hypotheses_that_the_graph_agrees_with_are_dropped():
    street = Street(80)
    true = np.array([pose.as_array() for pose in street.true])
    assert recognize_sequences(true, street.edges, street.clouds, street.trajectory) == []


def test_without_keyframes_nothing_is_recognized():
    assert (
        recognize_sequences(
            np.zeros((1, 3)), edges_of(), [Street(80).clouds[0]], tracked_trajectory(np.zeros(3), edges_of())
        )
        == []
    )
