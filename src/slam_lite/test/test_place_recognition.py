import dataclasses
import tracemalloc

import numpy as np
import pytest

from planar import Pose2, wrap
from slam_lite.graph.drift import drift_along, on_average, shortest_ways
from slam_lite.graph.pose_graph import Edge, edges_of
from slam_lite.loops.lasting import lasting
from slam_lite.loops.place_recognition import Appearance, Hypothesis, appearance_of, hypotheses, say_the_same
from slam_lite.loops.sight import share_seen_through
from slam_lite.mapper import Mapper
from slam_lite.surface import Surface, joined, surface_of

# two bins of the profiles, and what an axis may err
LIKE = (0.5, 0.05)


def seen_around(office, drive, middle):
    keys = range(middle - 40, middle + 41)
    origin = drive[middle].base_in_map.inverse()
    parts = [(surface_of(drive[k].scan, 20.0, 0.03), origin @ drive[k].base_in_map) for k in keys]
    return joined(parts)


def test_a_place_is_told_by_its_looks_and_so_is_the_pose_in_it(office):
    there, back = office.drive(laps=1.0), office.drive(laps=1.0, seed=1)
    places = [appearance_of(middle, seen_around(office, there, middle)) for middle in range(60, 300, 40)]
    turned = Pose2(1.0, -0.5, 0.7)
    seen = joined([(seen_around(office, back, 145), turned)])
    best = hypotheses(appearance_of(999, seen), places)[0]
    assert best.place == 140
    recent_in_place = there[140].base_in_map.inverse() @ back[145].base_in_map @ turned.inverse()
    assert best.recent_in_place.distance_to(recent_in_place) < LIKE[0]
    assert abs(wrap(best.recent_in_place.yaw - recent_in_place.yaw)) < LIKE[1]


def random_places(count):
    rng = np.random.default_rng(0)
    profiles = rng.uniform(0.0, 1.0, (count, 4, 256))
    profiles[:, :, 64:192] = 0.0
    lengths = np.sqrt((profiles.reshape(count, 2, 2, 256) ** 2).sum(axis=(2, 3))).repeat(2, axis=1)
    spectra = np.fft.rfft(profiles / lengths[:, :, None]).astype(np.complex64)
    return [Appearance(key, 0.0, spectrum) for key, spectrum in enumerate(spectra)]


def test_a_place_is_compared_with_many_as_with_few_at_a_time():
    recent, *places = random_places(301)
    told = hypotheses(recent, places)
    few = [each for i in range(0, 300, 50) for each in hypotheses(recent, places[i : i + 50])]
    likeliest = sorted(few, key=lambda each: -each.likeness)[: len(told)]
    assert [each.likeness for each in told] == pytest.approx([each.likeness for each in likeliest])
    assert {each.place for each in told} <= {each.place for each in few}


def test_a_place_is_compared_with_thousands_in_little_memory():
    recent, *places = random_places(2001)
    tracemalloc.start()
    hypotheses(recent, places)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 4e6  # of all spectra at once one copy takes 8e6


def test_where_nothing_has_a_direction_nothing_is_recognised():
    rng = np.random.default_rng(0)
    angles = rng.uniform(0.0, 2.0 * np.pi, 500)
    normals = np.column_stack((np.cos(angles), np.sin(angles))).astype(np.float32)
    leaves = Surface(rng.uniform(-5.0, 5.0, (500, 2)).astype(np.float32), normals)
    assert appearance_of(0, leaves) is None


def test_hypotheses_say_the_same_if_they_put_the_way_to_the_same_place():
    poses = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [90.0, 50.0, 1.0], [0.0, 0.0, 0.0]])
    poses[3] = (Pose2.from_array(poses[2]) @ Pose2(3.0, 0.0, 0.0)).as_array()
    one, same = Hypothesis(0, 2, Pose2(0.2, 0.1, 0.0), 0.9), Hypothesis(1, 3, Pose2(0.3, 0.0, 0.0), 0.8)
    other = Hypothesis(1, 3, Pose2(3.3, 0.0, 0.0), 0.8)
    assert say_the_same([one], [same, other], poses).tolist() == [[True, False]]
    assert say_the_same([one], [], poses).shape == (1, 0)


def test_an_error_in_heading_swings_what_lies_behind_it():
    step, turn = np.diag([1e4, 1e4, 1e12]), np.diag([1e12, 1e12, 1e2])
    ahead = Pose2(10.0, 0.0, 0.0)
    edges = edges_of(Edge(0, 1, ahead, turn), Edge(1, 2, ahead, step), Edge(2, 3, ahead, step))
    poses = np.array([[10.0 * i, 0.0, 0.0] for i in range(4)])
    ways, before = shortest_ways(0, 4, edges, np.full(3, 10.0))
    xy, yaw = drift_along(ways, before, poses, edges)
    np.testing.assert_allclose(ways, [0.0, 10.0, 20.0, 30.0])
    np.testing.assert_allclose(yaw, [0.0, 0.1, 0.1, 0.1], atol=1e-5)
    np.testing.assert_allclose(
        xy, [0.0, 1.0, np.hypot(2.0, 0.01), np.hypot(3.0, 0.01 * np.sqrt(2))], rtol=0.01
    )


def test_of_many_steps_that_may_have_slipped_few_have_but_of_a_new_beginning_nothing_is_known():
    step, anew = np.diag([0.04**-2, 0.04**-2, 0.07**-2]), np.diag([1e-6, 1e-6, 1e-4])
    ahead, count = Pose2(0.3, 0.0, 0.0), 900
    steps = [Edge(i, i + 1, ahead, step) for i in range(count)]
    edges = edges_of(*steps, Edge(count, count + 1, Pose2(), anew))
    poses = np.array([[0.3 * i, 0.0, 0.0] for i in range(count + 2)])
    ways, before = shortest_ways(0, len(poses), edges, np.full(len(edges), 0.3))
    xy, yaw = drift_along(ways, before, poses, on_average(edges))
    assert yaw[count] < 0.9 and xy[count] < 150.0  # and not 2.1 rad and 320 m
    assert yaw[count + 1] > 90.0 and xy[count + 1] > 900.0


@pytest.fixture(scope="module")
def carried_off(office):
    """A drive round the office, and another that begins elsewhere; between them the laser was covered.

    The other is 42 m long: a place takes 12 m to be looked at, and must go on alike for 11 m.
    """
    before, after = office.drive(laps=1.0), office.drive(laps=1.5, seed=1)[120:]
    carried = Pose2(60.0, -40.0, 2.0)
    covered = dataclasses.replace(after[0].scan, ranges=np.full(181, np.nan, dtype=np.float32))
    after = [after[0]._replace(scan=covered), *after[1:]]
    return before, [s._replace(base_in_odom=carried @ s.base_in_odom) for s in after]


def errors(drive, mapper):
    updates = [mapper.insert(sighting.base_in_odom, sighting.scan) for sighting in drive]
    mapper.settle()
    keys = [sighting.base_in_map for sighting, update in zip(drive, updates) if update and update.is_key]
    poses = mapper.key_poses[-len(keys) :]
    return [key.distance_to(Pose2.from_array(pose)) for key, pose in zip(keys, poses)]


def test_a_robot_that_was_carried_off_is_recognised_where_it_has_been_before(carried_off):
    before, after = carried_off
    assert max(errors(before + after, Mapper())) < 0.15


def test_it_is_recognised_in_a_saved_map_as_well(carried_off):
    before, after = carried_off
    first = Mapper()
    errors(before, first)
    resumed = Mapper()
    resumed.resume(first.state())
    resumed.insert(before[-1].base_in_odom, before[-1].scan)
    # what little was seen before the first turn of the way has no closure of its own
    assert max(errors(after, resumed)[30:]) < 0.15


def test_a_wall_is_seen_through_only_where_it_is_not():
    along = np.arange(-3.0, 3.0, 0.05)
    wall = points(np.column_stack((np.full_like(along, 2.0), along)))
    behind = points(np.column_stack((np.full_like(along, 4.0), 2.0 * along)))
    before = points(np.column_stack((np.full_like(along, 1.0), 0.5 * along)))
    assert share_seen_through(wall, [(wall, Pose2())]) == 0.0
    assert share_seen_through(wall, [(behind, Pose2())]) == 1.0
    assert share_seen_through(wall, [(before, Pose2())]) == 0.0


def points(points_xy) -> Surface:
    return Surface(points_xy.astype(np.float32), np.zeros((len(points_xy), 2), dtype=np.float32))


def test_of_a_sparse_stretch_only_what_lasts_is_kept():
    """A car stands beside the way, somebody walks along with the robot."""
    car = points(np.array([[4.0, 2.0], [4.0, 2.3], [4.0, 2.6]]))
    person = points(np.array([[1.5, 0.0], [1.5, 0.2], [1.5, 0.4]]))
    scans = []
    for step in range(12):
        pose = Pose2(0.5 * step, 0.0, 0.1)
        seen = points(pose.inverse().transform_points(car.points_xy))
        scans.append((joined([(seen, Pose2()), (person, Pose2())]), pose))
    kept = lasting(scans)
    assert len(kept) == 12 * len(car)
    assert np.abs(kept.points_xy[:, 0] - 4.0).max() < 1e-3


def test_a_stretch_on_which_nothing_is_seen_has_nothing_that_lasts():
    assert len(lasting([(points(np.empty((0, 2))), Pose2())] * 10)) == 0
