"""Loop closures in smooth corridors, where matches are degenerate."""

import dataclasses
import math

import numpy as np
import pytest

from planar import Pose2, wrap
from slam_lite.config import MapperSettings
from slam_lite.graph.drift import variances_xy
from slam_lite.graph.pose_graph import Edge, edges_of
from slam_lite.loops.degeneracy import constraint_at_peak, refine_at
from slam_lite.loops.loop_candidates import LoopCandidate, count_alternatives
from slam_lite.loops.loop_closure import LoopClosure, LoopClosureVerifier, agree, contradict
from slam_lite.loops.loop_search import find_loop_closure
from slam_lite.matching.correlative import Peak, SearchWindow, search_branch_and_bound
from slam_lite.matching.local_map import LocalMap
from slam_lite.point_cloud import PointCloud

KEYFRAMES, HEADING = 40, 0.4
# Error of the graph along the corridor and across it [m].
ERROR_ALONG, ERROR_ACROSS = 1.5, 0.25


def wall(y, facing, x0=-15.0, x1=15.0):
    x = np.arange(x0, x1, 0.05)
    return np.column_stack((x, np.full_like(x, y))), np.tile([0.0, facing], (len(x), 1))


def seen_from(pose, walls):
    """The points of walls, given in the corridor's frame, seen from a pose in it."""
    points, normals = (np.concatenate(parts) for parts in zip(*walls))
    turn = Pose2(0.0, 0.0, -pose.yaw)
    return PointCloud(
        pose.inverse().transform_points(points).astype(np.float32),
        turn.transform_points(normals).astype(np.float32),
    )


def there_and_back(walls, error_along=ERROR_ALONG):
    """True poses of keyframes there and back, those of the graph, and the keyframes' points.

    The robot's heading is askew, so that the corridor is not along the axes of any keyframe.
    """
    true = [Pose2(0.2 * i, 0.0, HEADING) for i in range(KEYFRAMES)]
    true += [Pose2(pose.x, pose.y + 0.1, pose.yaw) for pose in true]
    estimated = [pose.as_array() for pose in true]
    for pose in estimated[KEYFRAMES:]:
        pose[:2] += error_along, ERROR_ACROSS
    return true, np.array(estimated), [seen_from(pose, walls) for pose in true]


def closure_in(walls, window, error_along=ERROR_ALONG):
    true, poses, clouds = there_and_back(walls, error_along)
    place, recent = 12, KEYFRAMES + 12
    guess = Pose2.from_array(poses[place]).inverse() @ Pose2.from_array(poses[recent])
    candidate = LoopCandidate(place, recent, 8, window, 1.0, guess)
    closure = find_loop_closure(candidate, poses, clouds, LocalMap(), MapperSettings())
    return closure, true[place].inverse() @ true[recent]


SMOOTH = (wall(-1.0, 1.0), wall(1.2, -1.0))
# A short one with both ends visible.
CLOSED = (
    *(wall(y, facing, -1.0, 9.0) for y, facing in ((-1.0, 1.0), (1.2, -1.0))),
    *(tuple(column[:, ::-1] for column in wall(x, facing, -1.0, 1.2)) for x, facing in ((-1, 1), (9, -1))),
)


def error_of(closure, truth):
    measured = closure.edge.second_in_first
    return np.array([measured.x - truth.x, measured.y - truth.y, wrap(measured.yaw - truth.yaw)])


@pytest.mark.parametrize("window", [SearchWindow(4.0, 0.1), SearchWindow(0.35, 0.1)], ids=["wide", "narrow"])
def test_in_a_smooth_corridor_a_closure_measures_across_and_not_along(window):
    closure, truth = closure_in(SMOOTH, window)
    along = np.array([math.cos(-HEADING), math.sin(-HEADING)])
    across = np.array([-along[1], along[0]])
    covariance = np.linalg.inv(closure.edge.information + 1e-9 * np.eye(3))[:2, :2]
    assert along @ covariance @ along > 100.0**2
    assert across @ covariance @ across < 0.02**2
    off = error_of(closure, truth)
    assert abs(off[:2] @ across) < 0.02 and abs(off[2]) < 0.005
    # it stays where the graph estimated it to be, and is not worse met for being wrong there
    assert off[:2] @ along == pytest.approx(ERROR_ALONG, abs=0.05)
    assert off @ closure.edge.information @ off < 9.0


def test_where_the_corridors_ends_are_visible_a_closure_is_not_degenerate():
    closure, truth = closure_in(CLOSED, SearchWindow(4.0, 0.1))
    assert np.hypot(*error_of(closure, truth)[:2]) < 0.02
    assert not closure.degenerate_direction.any()
    assert variances_xy(edges_of(closure.edge))[0] < 0.1**2


def test_degenerate_closures_do_not_contradict_others_along_the_corridor():
    degenerate, _ = closure_in(SMOOTH, SearchWindow(4.0, 0.1))
    elsewhere, _ = closure_in(SMOOTH, SearchWindow(8.0, 0.1), error_along=7.0)
    assert not contradict(degenerate, elsewhere, there_and_back(SMOOTH)[1])


def test_a_degenerate_closure_does_not_confirm_one_that_is_not():
    poses = there_and_back(SMOOTH)[1]
    degenerate, _ = closure_in(SMOOTH, SearchWindow(4.0, 0.1))
    other = moved_on(degenerate, 25)
    assert agree(degenerate, other, poses)
    precise = dataclasses.replace(degenerate, degenerate_direction=np.zeros(2))
    assert not agree(precise, other, poses) and not agree(other, precise, poses)
    assert agree(precise, dataclasses.replace(other, degenerate_direction=np.zeros(2)), poses)


def moved_on(closure, keyframes):
    """A consistent closure so many keyframes later, at both ends."""
    edge = closure.edge
    edge = dataclasses.replace(edge, first=edge.first + keyframes, second=edge.second + keyframes)
    return dataclasses.replace(closure, edge=edge)


def test_two_places_across_a_corridor_that_look_alike_are_no_degeneracy():
    seen, local_map = seen_from(Pose2(), SMOOTH), LocalMap()
    local_map.clear(Pose2())
    local_map.add(seen, Pose2())

    def constraint_with(degenerate_direction):
        peak = Peak(Pose2(), 1.0, True, np.array(degenerate_direction))
        return constraint_at_peak(
            peak, Pose2(), seen, local_map, lambda start: refine_at(start, seen, local_map, 0.6)
        )

    assert constraint_with([0.0, 1.0]) is None
    assert abs(constraint_with([1.0, 0.0]).degenerate_direction[0]) == pytest.approx(1.0, abs=1e-3)


def test_the_variance_of_an_edge_is_that_of_its_worst_direction():
    closure, _ = closure_in(SMOOTH, SearchWindow(4.0, 0.1))
    assert variances_xy(edges_of(closure.edge))[0] > 100.0**2


THICKNESS = 0.15


def end_of_a_wall(x, facing):
    """One side of a wall, and its end, whose points form no line."""
    end = np.column_stack((np.linspace(-THICKNESS, 0.0, 7), np.full(7, 0.5)))
    edge = np.column_stack((np.full(3, x), np.linspace(0.5, 0.6, 3)))
    corner = np.concatenate((end, edge))
    return (corner, np.zeros_like(corner)), tuple(column[:, ::-1] for column in wall(x, facing, 0.6, 2.5))


def test_the_other_side_of_a_wall_does_not_measure_its_distance():
    floor = wall(-1.0, 1.0, -4.0, 4.0)
    known, seen = (
        seen_from(Pose2(), (floor, *end_of_a_wall(x, facing)))
        for x, facing in ((0.0, 1.0), (-THICKNESS, -1.0))
    )
    local_map = LocalMap()
    local_map.clear(Pose2())
    local_map.add(known, Pose2())
    peak = search_branch_and_bound(seen, local_map, Pose2(), SearchWindow(0.5, 0.1), 0.5, apart=0.6)
    assert peak.base_pose.x > 0.5 * THICKNESS  # the search ignores the sides
    found = constraint_at_peak(
        peak, Pose2(), seen, local_map, lambda start: refine_at(start, seen, local_map, 0.5)
    )
    off = found.base_in_place.as_array()
    assert off @ found.information @ off < 4.0


STREET = np.array([(0.5 * i, 40.0 if i >= 200 else 0.0, 0.0) for i in range(300)])


def recognized(number, ratio, alternatives):
    """A loop closure between two parallel streets that look alike, found by place recognition alone."""
    window = SearchWindow(4.0, 0.15)
    candidate = LoopCandidate(number, 200 + number, 39, window, 3.0, Pose2(), True, alternatives)
    edge = Edge(number, 200 + number, Pose2(), 100.0 * np.eye(3), is_loop=True)
    return LoopClosure(edge, candidate, np.zeros(2), ratio)


@pytest.mark.parametrize(
    "ratios, alternatives, is_accepted",
    [
        ((1.2, 2.3, 3.0), 3000.0, False),  # a room that looks like another one, 215 m away
        ((1.2, 2.3, 3.0), 30.0, True),
        ((3.5, 3.5, 3.5), 3000.0, True),
    ],
)
def test_recognized_places_must_outweigh_the_number_of_places_where_the_robot_may_be(
    ratios, alternatives, is_accepted
):
    closures = [recognized(n, ratio, alternatives) for n, ratio in zip((0, 14, 28), ratios)]
    verifier = LoopClosureVerifier(STREET, edges_of())
    assert bool(verifier.verify(closures[-1], closures[:-1])) == is_accepted


def test_loop_closures_of_one_keyframe_to_several_places_count_once():
    first, second, last = (recognized(n, 3.5, 3000.0) for n in (0, 14, 28))
    same_scan = dataclasses.replace(
        second, edge=dataclasses.replace(first.edge, first=1, second_in_first=Pose2(-0.5))
    )
    verifier = LoopClosureVerifier(STREET, edges_of())
    assert not verifier.verify(last, [first, same_scan])
    assert verifier.verify(last, [first, second])


def test_alternatives_are_the_places_and_headings_within_the_drift():
    places, drift = np.arange(0, 100, 10), np.tile([2.0, 0.01], (10, 1))
    # Within 1.5 * 2 m + 4 m of keyframe 50, 25 m along the street: those at 20, 25 and 30 m.
    assert count_alternatives(50, places, STREET, drift) == 3.0
    assert count_alternatives(50, places, STREET, np.tile([2.0, 9.0], (10, 1))) == pytest.approx(
        3.0 * np.pi / 0.15
    )
    assert count_alternatives(250, places, STREET, drift) == 0.0
