"""A robot returns through a yard of trees, of which each scan sees only a few points."""

import math

import numpy as np
import pytest

from planar import Pose2, Scan
from slam_lite.back_end import BackEnd
from slam_lite.config import MapperSettings
from slam_lite.graph.pose_graph import Edge, Edges, chi_squares, edges_of
from slam_lite.loops.revisited_segments import match_revisited_segments
from slam_lite.loops.tracked_trajectory import tracked_trajectory
from slam_lite.matching.local_map import long_range_map
from slam_lite.point_cloud import point_cloud_of

KEYFRAMES, STEP, BEAMS, RANGE = 200, 0.4, 181, 30.0
FIRM, LOOSE = np.diag([40.0**2, 40.0**2, 200.0**2]), np.diag([25.0**2, 25.0**2, 14.0**2])
# Wheel slips by keyframe: metres and radians.
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
    ranges[ranges > RANGE] = np.inf
    scan = Scan(0.0, angles[0], angles[1] - angles[0], ranges.astype(np.float32), 0.1, 80.0)
    return point_cloud_of(scan, 80.0, 0.05)


class Yard:
    """Keyframes there and back: their true poses and points, and the measured steps and poses."""

    def __init__(self, seed, there_again=True):
        rng = np.random.default_rng(seed)
        world = trees(rng)
        self.true = [Pose2(STEP * i, 0.0, 0.0) for i in range(KEYFRAMES)]
        self.true += [Pose2(pose.x, 0.5, math.pi) for pose in reversed(self.true)]
        elsewhere = world if there_again else trees(rng)
        worlds = [world] * KEYFRAMES + [elsewhere] * KEYFRAMES
        self.clouds = [seen_from(pose, each, rng) for pose, each in zip(self.true, worlds)]
        steps = [a.inverse() @ b for a, b in zip(self.true, self.true[1:])]
        for keyframe, slip in SLIPS.items():
            steps[keyframe] = steps[keyframe] @ slip
        steps = [step @ Pose2(*rng.normal(0.0, (0.01, 0.01, 0.001))) for step in steps]
        self.edges = edges_of(*(Edge(i, i + 1, step, LOOSE) for i, step in enumerate(steps)))
        self.poses = tracked_trajectory(np.zeros(3), self.edges).poses
        self.poses[KEYFRAMES:, :2] += [1.0, -1.2]

    def chi_squares(self, edges):
        """Chi-square of each edge at the true poses."""
        return chi_squares(np.array([pose.as_array() for pose in self.true]), edges_of(*edges))


@pytest.mark.parametrize("seed", [60, 61, 62])
def test_loops_are_closed_on_the_return_despite_wheel_slips(seed):
    yard = Yard(seed)
    found = match_revisited_segments(yard.poses, yard.edges, yard.clouds, long_range_map())
    assert len(found) > 12
    chi = yard.chi_squares(found)
    assert np.median(chi) < 4.0
    assert np.mean(chi > 16.0) < 0.2
    assert all(edge.is_loop and edge.first < KEYFRAMES < edge.second for edge in found)


def with_loop(yard, first, second):
    """The yard's edges, with a loop closure between two keyframes."""
    true = yard.true[first].inverse() @ yard.true[second]
    loop = edges_of(Edge(first, second, true, FIRM, is_loop=True))
    return Edges(*(np.concatenate(pair) for pair in zip(vars(yard.edges).values(), vars(loop).values())))


@pytest.mark.parametrize("seed", [60, 68])
def test_the_nearest_loop_closure_predicts_the_pose_however_wrong_the_graph_is(seed):
    yard = Yard(seed)
    yard.poses[KEYFRAMES:, 1] += 12.0
    assert match_revisited_segments(yard.poses, yard.edges, yard.clouds, long_range_map()) == []
    edges = with_loop(yard, KEYFRAMES - 30, KEYFRAMES + 30)
    found = match_revisited_segments(yard.poses, edges, yard.clouds, long_range_map())
    assert len(found) > 12
    assert np.mean(yard.chi_squares(found) > 16.0) < 0.2


@pytest.mark.parametrize("seed", [63, 64])
def test_another_yard_does_not_match(seed):
    yard = Yard(seed, there_again=False)
    assert match_revisited_segments(yard.poses, yard.edges, yard.clouds, long_range_map()) == []


def optimized(yard, settings=MapperSettings()):
    back_end = BackEnd(settings)
    back_end.restore(yard.clouds, yard.poses, yard.edges)
    back_end.run_final_optimization()
    return back_end


def return_errors(poses):
    """Position errors (N, 2) of the return relative to the outward path [m]."""
    poses = [Pose2.from_array(pose) for pose in poses]
    there_and_back = [
        (poses[keyframe], poses[2 * KEYFRAMES - 1 - keyframe]) for keyframe in range(10, KEYFRAMES, 10)
    ]
    return np.array(
        [
            there.inverse().transform_points([[back.x, back.y]])[0] - [0.0, 0.5]
            for there, back in there_and_back
        ]
    )


@pytest.mark.parametrize("seed", [65, 67])
def test_the_final_optimization_corrects_the_return_and_is_stable(seed):
    yard = Yard(seed)
    back_end = optimized(yard)
    before, after = (np.hypot(*return_errors(poses).T).mean() for poses in (yard.poses, back_end.poses))
    assert before > 1.0
    assert after < 0.3
    found = len(back_end.edges) - len(yard.edges)
    back_end.run_final_optimization()
    assert len(back_end.edges) - len(yard.edges) - found < 0.3 * found


def test_close_loops_switches_it_off():
    yard = Yard(66)
    assert len(optimized(yard, MapperSettings(close_loops=False)).edges) == len(yard.edges)


def test_a_break_of_the_trajectory_counts_as_a_long_path():
    steps = [Edge(i, i + 1, Pose2(1.0, 0.0, 0.1), FIRM) for i in range(40)]
    steps[20] = Edge(20, 21, Pose2(1.0, 0.0, 0.1), np.diag([4.0, 4.0, 10.0]))
    trajectory = tracked_trajectory(np.array([1.0, 2.0, 0.3]), edges_of(*steps))
    np.testing.assert_allclose(
        trajectory.poses[2],
        (Pose2(1.0, 2.0, 0.3) @ Pose2(1.0, 0.0, 0.1) @ steps[1].second_in_first).as_array(),
    )
    assert trajectory.within(18, 14.5) == (4, 20)
    assert trajectory.within(24, 14.5) == (21, 38)
