"""Closures along smooth corridors, where a match may lie anywhere."""

import dataclasses
import math

import numpy as np
import pytest

from planar import Pose2, wrap
from slam_lite.config import MapperSettings
from slam_lite.graph.drift import variances_xy
from slam_lite.graph.pose_graph import edges_of
from slam_lite.loops.loop_closure import Candidate, agree, contradict, find_closure
from slam_lite.loops.sliding import known_of, refined
from slam_lite.matching.correlative import Peak, Window, search_far
from slam_lite.matching.local_map import LocalMap
from slam_lite.surface import Surface

KEYS, HEADING = 40, 0.4
# How far along the corridor, and across it, the graph is off.
OFF_ALONG, OFF_ACROSS = 1.5, 0.25


def wall(y, facing, x0=-15.0, x1=15.0):
    x = np.arange(x0, x1, 0.05)
    return np.column_stack((x, np.full_like(x, y))), np.tile([0.0, facing], (len(x), 1))


def seen_from(pose, walls):
    """The surface of walls in the corridor's frame, seen from a pose in it."""
    points, normals = (np.concatenate(parts) for parts in zip(*walls))
    turn = Pose2(0.0, 0.0, -pose.yaw)
    return Surface(
        pose.inverse().transform_points(points).astype(np.float32),
        turn.transform_points(normals).astype(np.float32),
    )


def way_back(walls, off_along=OFF_ALONG):
    """Poses in the corridor of keys there and back, those the graph believes, and the keys' surfaces.

    The robot looks askew, so that the corridor does not lie along the axes of any key.
    """
    true = [Pose2(0.2 * i, 0.0, HEADING) for i in range(KEYS)]
    true += [Pose2(pose.x, pose.y + 0.1, pose.yaw) for pose in true]
    believed = [pose.as_array() for pose in true]
    for pose in believed[KEYS:]:
        pose[:2] += off_along, OFF_ACROSS
    return true, np.array(believed), [seen_from(pose, walls) for pose in true]


def closure_in(walls, window, off_along=OFF_ALONG):
    true, poses, surfaces = way_back(walls, off_along)
    place, recent = 12, KEYS + 12
    guess = Pose2.from_array(poses[place]).inverse() @ Pose2.from_array(poses[recent])
    candidate = Candidate(place, recent, 8, window, 1.0, guess)
    closure = find_closure(candidate, poses, surfaces, LocalMap(), MapperSettings())
    return closure, true[place].inverse() @ true[recent]


SMOOTH = (wall(-1.0, 1.0), wall(1.2, -1.0))
# A short one, of which both ends are seen.
CLOSED = (
    *(wall(y, facing, -1.0, 9.0) for y, facing in ((-1.0, 1.0), (1.2, -1.0))),
    *(tuple(column[:, ::-1] for column in wall(x, facing, -1.0, 1.2)) for x, facing in ((-1, 1), (9, -1))),
)


def off_of(closure, truth):
    measured = closure.edge.second_in_first
    return np.array([measured.x - truth.x, measured.y - truth.y, wrap(measured.yaw - truth.yaw)])


@pytest.mark.parametrize("window", [Window(4.0, 0.1), Window(0.35, 0.1)], ids=["wide", "narrow"])
def test_in_a_smooth_corridor_a_closure_knows_the_way_across_and_nothing_of_the_way_along(window):
    closure, truth = closure_in(SMOOTH, window)
    along = np.array([math.cos(-HEADING), math.sin(-HEADING)])
    across = np.array([-along[1], along[0]])
    covariance = np.linalg.inv(closure.edge.information + 1e-9 * np.eye(3))[:2, :2]
    assert along @ covariance @ along > 100.0**2
    assert across @ covariance @ across < 0.02**2
    off = off_of(closure, truth)
    assert abs(off[:2] @ across) < 0.02 and abs(off[2]) < 0.005
    # it stays where the graph believed it to be, and is not worse met for being wrong there
    assert off[:2] @ along == pytest.approx(OFF_ALONG, abs=0.05)
    assert off @ closure.edge.information @ off < 9.0


def test_where_the_corridors_ends_are_seen_a_closure_knows_all():
    closure, truth = closure_in(CLOSED, Window(4.0, 0.1))
    assert np.hypot(*off_of(closure, truth)[:2]) < 0.02
    assert not closure.slide.any()
    assert variances_xy(edges_of(closure.edge))[0] < 0.1**2


def test_of_how_far_the_robot_went_along_a_corridor_closures_that_slide_say_nothing_against_others():
    sliding, _ = closure_in(SMOOTH, Window(4.0, 0.1))
    elsewhere, _ = closure_in(SMOOTH, Window(8.0, 0.1), off_along=7.0)
    assert not contradict(sliding, elsewhere, way_back(SMOOTH)[1])


def test_who_slides_is_no_witness_for_who_does_not():
    poses = way_back(SMOOTH)[1]
    sliding, _ = closure_in(SMOOTH, Window(4.0, 0.1))
    other = moved_on(sliding, 25)
    assert agree(sliding, other, poses)
    sure = dataclasses.replace(sliding, slide=np.zeros(2))
    assert not agree(sure, other, poses) and not agree(other, sure, poses)
    assert agree(sure, dataclasses.replace(other, slide=np.zeros(2)), poses)


def moved_on(closure, keys):
    """A closure that says the same from so many keys further on, both ways."""
    edge = closure.edge
    edge = dataclasses.replace(edge, first=edge.first + keys, second=edge.second + keys)
    return dataclasses.replace(closure, edge=edge)


def test_two_places_across_a_corridor_that_look_alike_are_no_slide():
    seen, local_map = seen_from(Pose2(), SMOOTH), LocalMap()
    local_map.clear(Pose2())
    local_map.add(seen, Pose2())

    def known_where_it_fits(slide):
        peak = Peak(Pose2(), 1.0, True, np.array(slide))
        return known_of(peak, Pose2(), seen, local_map, lambda start: refined(seen, local_map, start, 0.6))

    assert known_where_it_fits([0.0, 1.0]) is None
    assert abs(known_where_it_fits([1.0, 0.0]).slide[0]) == pytest.approx(1.0, abs=1e-3)


def test_an_edge_is_as_uncertain_as_it_is_in_its_worst_direction():
    closure, _ = closure_in(SMOOTH, Window(4.0, 0.1))
    assert variances_xy(edges_of(closure.edge))[0] > 100.0**2


THICKNESS = 0.15


def end_of_a_wall(x, facing):
    """One side of a wall, and its end: of the points there no line can be told."""
    end = np.column_stack((np.linspace(-THICKNESS, 0.0, 7), np.full(7, 0.5)))
    edge = np.column_stack((np.full(3, x), np.linspace(0.5, 0.6, 3)))
    corner = np.concatenate((end, edge))
    return (corner, np.zeros_like(corner)), tuple(column[:, ::-1] for column in wall(x, facing, 0.6, 2.5))


def test_who_sees_a_walls_other_side_does_not_know_how_near_it_is():
    floor = wall(-1.0, 1.0, -4.0, 4.0)
    known, seen = (
        seen_from(Pose2(), (floor, *end_of_a_wall(x, facing)))
        for x, facing in ((0.0, 1.0), (-THICKNESS, -1.0))
    )
    local_map = LocalMap()
    local_map.clear(Pose2())
    local_map.add(known, Pose2())
    peak = search_far(seen, local_map, Pose2(), Window(0.5, 0.1), 0.5, apart=0.6)
    assert peak.base_pose.x > 0.5 * THICKNESS  # it knows no sides
    found = known_of(peak, Pose2(), seen, local_map, lambda start: refined(seen, local_map, start, 0.5))
    off = found.base_in_place.as_array()
    assert off @ found.information @ off < 4.0
