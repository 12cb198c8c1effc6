import dataclasses
import tracemalloc

import numpy as np
import pytest

from planar import Pose2, wrap
from slam_lite.graph.drift import drift_along, shortest_paths, with_average_slip
from slam_lite.graph.pose_graph import Edge, edges_of
from slam_lite.loops.place_recognition import (
    PlaceDescriptor,
    PlaceHypothesis,
    are_consistent,
    match_places,
    place_descriptor,
)
from slam_lite.loops.static_points import static_points
from slam_lite.loops.visibility import seen_through_fraction
from slam_lite.mapper import Mapper
from slam_lite.point_cloud import PointCloud, merge_clouds, point_cloud_of

# two bins of the profiles, and the error of an axis
TOLERANCE = (0.5, 0.05)


def seen_around(office, drive, middle):
    keyframes = range(middle - 40, middle + 41)
    origin = drive[middle].base_in_map.inverse()
    parts = [(point_cloud_of(drive[k].scan, 20.0, 0.03), origin @ drive[k].base_in_map) for k in keyframes]
    return merge_clouds(parts)


def test_a_place_is_recognized_with_the_relative_pose(office):
    there, back = office.drive(laps=1.0), office.drive(laps=1.0, seed=1)
    places = [place_descriptor(middle, seen_around(office, there, middle)) for middle in range(60, 300, 40)]
    turned = Pose2(1.0, -0.5, 0.7)
    seen = merge_clouds([(seen_around(office, back, 145), turned)])
    best = match_places(place_descriptor(999, seen), places)[0]
    assert best.place == 140
    recent_in_place = there[140].base_in_map.inverse() @ back[145].base_in_map @ turned.inverse()
    assert best.recent_in_place.distance_to(recent_in_place) < TOLERANCE[0]
    assert abs(wrap(best.recent_in_place.yaw - recent_in_place.yaw)) < TOLERANCE[1]


def random_places(count):
    rng = np.random.default_rng(0)
    profiles = rng.uniform(0.0, 1.0, (count, 4, 256))
    profiles[:, :, 64:192] = 0.0
    lengths = np.sqrt((profiles.reshape(count, 2, 2, 256) ** 2).sum(axis=(2, 3))).repeat(2, axis=1)
    spectra = np.fft.rfft(profiles / lengths[:, :, None]).astype(np.complex64)
    return [PlaceDescriptor(keyframe, 0.0, spectrum) for keyframe, spectrum in enumerate(spectra)]


def test_batches_do_not_change_the_result():
    recent, *places = random_places(301)
    found = match_places(recent, places)
    few = [each for i in range(0, 300, 50) for each in match_places(recent, places[i : i + 50])]
    most_similar = sorted(few, key=lambda each: -each.similarity)[: len(found)]
    assert [each.similarity for each in found] == pytest.approx([each.similarity for each in most_similar])
    assert {each.place for each in found} <= {each.place for each in few}


def test_thousands_of_places_are_compared_in_little_memory():
    recent, *places = random_places(2001)
    tracemalloc.start()
    match_places(recent, places)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 4e6  # of all spectra at once one copy takes 8e6


def test_a_place_without_main_directions_has_no_descriptor():
    rng = np.random.default_rng(0)
    angles = rng.uniform(0.0, 2.0 * np.pi, 500)
    normals = np.column_stack((np.cos(angles), np.sin(angles))).astype(np.float32)
    leaves = PointCloud(rng.uniform(-5.0, 5.0, (500, 2)).astype(np.float32), normals)
    assert place_descriptor(0, leaves) is None


def test_hypotheses_are_consistent_if_they_put_the_trajectory_to_the_same_place():
    poses = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [90.0, 50.0, 1.0], [0.0, 0.0, 0.0]])
    poses[3] = (Pose2.from_array(poses[2]) @ Pose2(3.0, 0.0, 0.0)).as_array()
    one, same = (
        PlaceHypothesis(0, 2, Pose2(0.2, 0.1, 0.0), 0.9),
        PlaceHypothesis(1, 3, Pose2(0.3, 0.0, 0.0), 0.8),
    )
    other = PlaceHypothesis(1, 3, Pose2(3.3, 0.0, 0.0), 0.8)
    assert are_consistent([one], [same, other], poses).tolist() == [[True, False]]
    assert are_consistent([one], [], poses).shape == (1, 0)


def test_an_error_in_heading_moves_all_that_follows():
    step, turn = np.diag([1e4, 1e4, 1e12]), np.diag([1e12, 1e12, 1e2])
    ahead = Pose2(10.0, 0.0, 0.0)
    edges = edges_of(Edge(0, 1, ahead, turn), Edge(1, 2, ahead, step), Edge(2, 3, ahead, step))
    poses = np.array([[10.0 * i, 0.0, 0.0] for i in range(4)])
    paths, before = shortest_paths(0, 4, edges, np.full(3, 10.0))
    xy, yaw = drift_along(paths, before, poses, edges)
    np.testing.assert_allclose(paths, [0.0, 10.0, 20.0, 30.0])
    np.testing.assert_allclose(yaw, [0.0, 0.1, 0.1, 0.1], atol=1e-5)
    np.testing.assert_allclose(
        xy, [0.0, 1.0, np.hypot(2.0, 0.01), np.hypot(3.0, 0.01 * np.sqrt(2))], rtol=0.01
    )


def test_loose_steps_count_by_their_average_and_a_new_trajectory_is_unknown():
    step, new_trajectory = np.diag([0.04**-2, 0.04**-2, 0.07**-2]), np.diag([1e-6, 1e-6, 1e-4])
    ahead, count = Pose2(0.3, 0.0, 0.0), 900
    steps = [Edge(i, i + 1, ahead, step) for i in range(count)]
    edges = edges_of(*steps, Edge(count, count + 1, Pose2(), new_trajectory))
    poses = np.array([[0.3 * i, 0.0, 0.0] for i in range(count + 2)])
    paths, before = shortest_paths(0, len(poses), edges, np.full(len(edges), 0.3))
    xy, yaw = drift_along(paths, before, poses, with_average_slip(edges))
    assert yaw[count] < 0.9 and xy[count] < 150.0  # and not 2.1 rad and 320 m
    assert yaw[count + 1] > 90.0 and xy[count + 1] > 900.0


@pytest.fixture(scope="module")
def carried_off(office):
    """A drive round the office, and another that starts elsewhere; between them the laser was covered.

    The other is 42 m long: a place descriptor takes 12 m, and places must look alike for 11 m.
    """
    before, after = office.drive(laps=1.0), office.drive(laps=1.5, seed=1)[120:]
    carried = Pose2(60.0, -40.0, 2.0)
    covered = dataclasses.replace(after[0].scan, ranges=np.full(181, np.nan, dtype=np.float32))
    after = [after[0]._replace(scan=covered), *after[1:]]
    return before, [s._replace(base_in_odom=carried @ s.base_in_odom) for s in after]


def errors(drive, mapper):
    updates = [mapper.insert(observation.base_in_odom, observation.scan) for observation in drive]
    mapper.run_final_optimization()
    keyframes = [
        observation.base_in_map
        for observation, update in zip(drive, updates)
        if update and update.is_keyframe
    ]
    poses = mapper.keyframe_poses[-len(keyframes) :]
    return [keyframe.distance_to(Pose2.from_array(pose)) for keyframe, pose in zip(keyframes, poses)]


def test_a_carried_robot_recognizes_where_it_has_been_before(carried_off):
    before, after = carried_off
    assert max(errors(before + after, Mapper())) < 0.15


def test_it_recognizes_places_of_a_saved_map_as_well(carried_off):
    before, after = carried_off
    first = Mapper()
    errors(before, first)
    resumed = Mapper()
    resumed.resume(first.state())
    resumed.insert(before[-1].base_in_odom, before[-1].scan)
    # the keyframes before the first turn see too little for a loop closure
    assert max(errors(after, resumed)[30:]) < 0.15


def test_beams_see_through_a_wall_only_if_they_end_behind_it():
    along = np.arange(-3.0, 3.0, 0.05)
    wall = points(np.column_stack((np.full_like(along, 2.0), along)))
    behind = points(np.column_stack((np.full_like(along, 4.0), 2.0 * along)))
    before = points(np.column_stack((np.full_like(along, 1.0), 0.5 * along)))
    assert seen_through_fraction(wall, [(wall, Pose2())]) == 0.0
    assert seen_through_fraction(wall, [(behind, Pose2())]) == 1.0
    assert seen_through_fraction(wall, [(before, Pose2())]) == 0.0


def points(points_xy) -> PointCloud:
    return PointCloud(points_xy.astype(np.float32), np.zeros((len(points_xy), 2), dtype=np.float32))


def test_moving_points_of_a_sparse_segment_are_removed():
    """A parked car, and a person who walks along with the robot."""
    car = points(np.array([[4.0, 2.0], [4.0, 2.3], [4.0, 2.6]]))
    person = points(np.array([[1.5, 0.0], [1.5, 0.2], [1.5, 0.4]]))
    scans = []
    for step in range(12):
        pose = Pose2(0.5 * step, 0.0, 0.1)
        seen = points(pose.inverse().transform_points(car.points_xy))
        scans.append((merge_clouds([(seen, Pose2()), (person, Pose2())]), pose))
    kept = static_points(scans)
    assert len(kept) == 12 * len(car)
    assert np.abs(kept.points_xy[:, 0] - 4.0).max() < 1e-3


def test_a_segment_without_points_has_no_static_points():
    assert len(static_points([(points(np.empty((0, 2))), Pose2())] * 10)) == 0
