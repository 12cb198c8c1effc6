"""A robot comes back through a yard of trees, of which each of its scans sees but a few points."""

import math

import numpy as np
import pytest

from planar import Pose2, Scan
from slam_lite.back_end import BackEnd
from slam_lite.config import MapperSettings
from slam_lite.graph.pose_graph import Edge, Edges, chi_squares, edges_of
from slam_lite.loops.way import way_of
from slam_lite.loops.ways_back import ways_back
from slam_lite.matching.local_map import wide_map
from slam_lite.surface import surface_of

KEYS, STEP, BEAMS, SIGHT = 200, 0.4, 181, 30.0
FIRM, LOOSE = np.diag([40.0**2, 40.0**2, 200.0**2]), np.diag([25.0**2, 25.0**2, 14.0**2])
# Where wheels have slipped, and by how much: metres and radians.
SLIPS = {60: Pose2(0.1, 0.15, 0.1), 300: Pose2(-0.1, 0.1, -0.12)}


def trees(rng):
    """Rows x, y, radius."""
    sides = rng.choice([-1.0, 1.0], 120)
    return np.column_stack(
        (rng.uniform(-15.0, 95.0, 120), sides * rng.uniform(2.5, 15.0, 120), rng.uniform(0.1, 0.3, 120))
    )


def seen_from(pose, world, rng):
    angles = math.pi / (BEAMS - 1) * np.arange(BEAMS) - 0.5 * math.pi
    x, y = pose.inverse().transform_points(world[:, :2]).T[:, :, None]
    along, beside = x * np.cos(angles) + y * np.sin(angles), y * np.cos(angles) - x * np.sin(angles)
    depth = world[:, 2:] ** 2 - beside**2
    hits = np.where((depth > 0.0) & (along > 0.0), along - np.sqrt(np.maximum(depth, 0.0)), np.inf)
    ranges = hits.min(axis=0) + rng.normal(0.0, 0.02, BEAMS)
    ranges[ranges > SIGHT] = np.inf
    scan = Scan(0.0, angles[0], angles[1] - angles[0], ranges.astype(np.float32), 0.1, 80.0)
    return surface_of(scan, 80.0, 0.05)


class Yard:
    """Keys there and back: their true poses, what they saw, and the steps and poses that were measured."""

    def __init__(self, seed, there_again=True):
        rng = np.random.default_rng(seed)
        world = trees(rng)
        self.true = [Pose2(STEP * i, 0.0, 0.0) for i in range(KEYS)]
        self.true += [Pose2(pose.x, 0.5, math.pi) for pose in reversed(self.true)]
        elsewhere = world if there_again else trees(rng)
        worlds = [world] * KEYS + [elsewhere] * KEYS
        self.surfaces = [seen_from(pose, each, rng) for pose, each in zip(self.true, worlds)]
        steps = [a.inverse() @ b for a, b in zip(self.true, self.true[1:])]
        for key, slip in SLIPS.items():
            steps[key] = steps[key] @ slip
        steps = [step @ Pose2(*rng.normal(0.0, (0.01, 0.01, 0.001))) for step in steps]
        self.edges = edges_of(*(Edge(i, i + 1, step, LOOSE) for i, step in enumerate(steps)))
        self.poses = way_of(np.zeros(3), self.edges).poses
        self.poses[KEYS:, :2] += [1.0, -1.2]

    def chi_squares(self, edges):
        """How badly the truth meets them."""
        return chi_squares(np.array([pose.as_array() for pose in self.true]), edges_of(*edges))


@pytest.mark.parametrize("seed", [60, 61, 62])
def test_the_way_back_is_tied_but_where_wheels_have_slipped(seed):
    yard = Yard(seed)
    found = ways_back(yard.poses, yard.edges, yard.surfaces, wide_map())
    assert len(found) > 12
    chi = yard.chi_squares(found)
    assert np.median(chi) < 4.0
    assert np.mean(chi > 16.0) < 0.2
    assert all(edge.is_loop and edge.first < KEYS < edge.second for edge in found)


def with_loop(yard, first, second):
    """The yard's edges, with a closure between two keys."""
    true = yard.true[first].inverse() @ yard.true[second]
    loop = edges_of(Edge(first, second, true, FIRM, is_loop=True))
    return Edges(*(np.concatenate(pair) for pair in zip(vars(yard.edges).values(), vars(loop).values())))


@pytest.mark.parametrize("seed", [60, 68])
def test_the_last_tie_tells_where_the_robot_is_however_far_off_the_graph_is(seed):
    yard = Yard(seed)
    yard.poses[KEYS:, 1] += 12.0
    assert ways_back(yard.poses, yard.edges, yard.surfaces, wide_map()) == []
    edges = with_loop(yard, KEYS - 30, KEYS + 30)
    found = ways_back(yard.poses, edges, yard.surfaces, wide_map())
    assert len(found) > 12
    assert np.mean(yard.chi_squares(found) > 16.0) < 0.2


@pytest.mark.parametrize("seed", [63, 64])
def test_another_yard_is_no_way_back(seed):
    yard = Yard(seed, there_again=False)
    assert ways_back(yard.poses, yard.edges, yard.surfaces, wide_map()) == []


def settled(yard, settings=MapperSettings()):
    back_end = BackEnd(settings)
    back_end.restore(yard.surfaces, yard.poses, yard.edges)
    back_end.settle()
    return back_end


def misses(poses):
    """How far beside the way there the way back lies, (N,)."""
    poses = [Pose2.from_array(pose) for pose in poses]
    there_and_back = [(poses[key], poses[2 * KEYS - 1 - key]) for key in range(10, KEYS, 10)]
    return np.array(
        [
            there.inverse().transform_points([[back.x, back.y]])[0] - [0.0, 0.5]
            for there, back in there_and_back
        ]
    )


@pytest.mark.parametrize("seed", [65, 67])
def test_a_settled_map_is_true_there_and_stays_so(seed):
    yard = Yard(seed)
    back_end = settled(yard)
    before, after = (np.hypot(*misses(poses).T).mean() for poses in (yard.poses, back_end.poses))
    assert before > 1.0
    assert after < 0.3
    found = len(back_end.edges) - len(yard.edges)
    back_end.settle()
    assert len(back_end.edges) - len(yard.edges) - found < 0.3 * found


def test_who_wants_no_loops_closed_gets_none():
    yard = Yard(66)
    assert len(settled(yard, MapperSettings(close_loops=False)).edges) == len(yard.edges)


def test_a_robot_that_was_put_down_anew_has_driven_no_way_in_between():
    steps = [Edge(i, i + 1, Pose2(1.0, 0.0, 0.1), FIRM) for i in range(40)]
    steps[20] = Edge(20, 21, Pose2(1.0, 0.0, 0.1), np.diag([4.0, 4.0, 10.0]))
    way = way_of(np.array([1.0, 2.0, 0.3]), edges_of(*steps))
    np.testing.assert_allclose(
        way.poses[2], (Pose2(1.0, 2.0, 0.3) @ Pose2(1.0, 0.0, 0.1) @ steps[1].second_in_first).as_array()
    )
    assert way.around(18, 14.5) == (4, 20)
    assert way.around(24, 14.5) == (21, 38)
