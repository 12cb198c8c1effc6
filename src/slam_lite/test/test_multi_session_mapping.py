"""Multi-session mapping: sessions in sequence, carried robots, moved furniture."""

import dataclasses
import math

import numpy as np
import pytest

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, wrap
from slam_lite.config import MapperSettings
from slam_lite.graph.pose_graph import Edge, chi_squares, edges_of
from slam_lite.graph.sparsification import sparsify
from slam_lite.keyframes import prune_keyframes
from slam_lite.loops.relocalization import Relocalizer, spread_places
from slam_lite.map_localizer import MapLocalizer
from slam_lite.mapper import Mapper
from slam_lite.matching.local_map import LocalMap
from slam_lite.odometry.checks import DiscontinuityDetector
from slam_lite.point_cloud import point_cloud_of
from slam_lite.rendering import Evidence, ScanBeams, SessionRenderer

# as in test_mapper: half a cell of the truth and the drift of a lap; and a cell of the map, for a single scan
TRACKED, FOUND = 0.15, 0.05


def mapped(drive, mapper):
    updates = [mapper.insert(observation.base_in_odom, observation.scan) for observation in drive]
    mapper.run_final_optimization()
    return updates


def errors(drive, updates, mapper):
    """Position error of each keyframe of a drive [m]."""
    keyframes = [
        observation.base_in_map
        for observation, update in zip(drive, updates)
        if update and update.is_keyframe
    ]
    poses = mapper.keyframe_poses[-len(keyframes) :]
    return [keyframe.distance_to(Pose2.from_array(pose)) for keyframe, pose in zip(keyframes, poses)]


def restarted(drive, stamp=0.0):
    """The drive with odometry that starts at zero, and the clock at ``stamp``."""
    back, earlier = drive[0].base_in_odom.inverse(), drive[0].scan.stamp - stamp
    return [
        s._replace(
            base_in_odom=back @ s.base_in_odom, scan=dataclasses.replace(s.scan, stamp=s.scan.stamp - earlier)
        )
        for s in drive
    ]


@pytest.fixture(scope="module")
def drive(office):
    return office.drive(laps=1.0)


@pytest.fixture(scope="module")
def state(drive):
    mapper = Mapper()
    mapped(drive, mapper)
    return mapper.state()


@pytest.mark.parametrize("seen_from", [Pose2(13.6, 5.0, -1.9), Pose2(8.0, 9.2, 2.9), Pose2(2.3, 6.0, 0.4)])
def test_a_robot_is_found_in_a_map_without_a_guess(office, state, seen_from):
    cloud = point_cloud_of(office.scan(seen_from), 20.0, 0.03)
    relocalizer = Relocalizer(state.clouds, state.poses, LocalMap())
    found = relocalizer.find_pose([(cloud, Pose2())])
    assert found.distance_to(seen_from) < FOUND
    assert abs(wrap(found.yaw - seen_from.yaw)) < 0.02


def test_a_scan_that_matches_at_two_places_is_located_at_neither(office, state):
    copy = Pose2(60.0, 0.0, 0.0)
    moved = np.array([(copy @ Pose2.from_array(pose)).as_array() for pose in state.poses])
    relocalizer = Relocalizer([*state.clouds, *state.clouds], np.vstack((state.poses, moved)), LocalMap())
    cloud = point_cloud_of(office.scan(Pose2(13.6, 5.0, -1.9)), 20.0, 0.03)
    assert relocalizer.find_pose([(cloud, Pose2())]) is None
    prior = Pose2(13.7, 5.2, -2.0)
    assert relocalizer.find_pose([(cloud, Pose2())], prior).distance_to(Pose2(13.6, 5.0, -1.9)) < FOUND


@pytest.mark.parametrize("off", [Pose2(0.3, -0.2, 0.1), Pose2(-0.15, 0.3, -0.1)])
def test_a_mapper_resumes_after_a_crash(office, off):
    """Halfway round, with an error of odometry since the checkpoint."""
    drive = office.drive(laps=1.3)
    mapper, crash, later = Mapper(), len(drive) // 2, len(drive) // 2 + 12
    mapped(drive[:crash], mapper)
    resumed = Mapper()
    resumed.resume_near(mapper.state(), drive[later].base_in_map @ off)
    updates = [resumed.insert(observation.base_in_odom, observation.scan) for observation in drive[later:]]
    assert updates[0].base_in_map.distance_to(drive[later].base_in_map) < TRACKED
    resumed.run_final_optimization()
    assert max(errors(drive[later:], updates, resumed)) < TRACKED


def test_without_a_match_the_robot_is_where_odometry_has_it(office, state):
    expected = Pose2(40.0, 40.0, 0.5)
    mapper = Mapper()
    mapper.resume_near(state, expected)
    observation = restarted(office.drive(laps=0.3), 100.0)[0]
    assert mapper.insert(observation.base_in_odom, observation.scan).base_in_map == expected


def test_places_are_spread_over_the_map(state):
    places = spread_places(state.poses, 4.0)
    chosen = state.poses[places, :2]
    apart = np.hypot(*(chosen[:, None] - chosen[None]).transpose(2, 0, 1))
    assert apart[apart > 0.0].min() > 4.0
    assert np.hypot(*(state.poses[:, None, :2] - chosen[None]).transpose(2, 0, 1)).min(axis=1).max() <= 4.0


@pytest.mark.parametrize("start, found_after", [(0, 0), (45, 0), (130, 100)])
def test_a_session_starts_anywhere_in_the_map_without_an_initial_pose(office, state, start, found_after):
    """In a smooth corridor one scan does not match uniquely; a segment of the trajectory does."""
    resumed = Mapper()
    resumed.resume(state)
    elsewhere = restarted(office.drive(laps=1.0, seed=3)[start:])
    updates = mapped(elsewhere, resumed)
    found, there = updates[found_after].base_in_map, elsewhere[found_after].base_in_map
    assert found.distance_to(there) < TRACKED
    assert max(errors(elsewhere, updates, resumed)) < TRACKED


def test_a_localizer_starts_anywhere_in_the_map_without_an_initial_pose(office, state):
    elsewhere = restarted(office.drive(laps=0.5, seed=3)[45:])
    localizer = MapLocalizer(MapperSettings(), state)
    updates = [localizer.insert(s.base_in_odom, s.scan) for s in elsewhere]
    there = [u.base_in_map.distance_to(s.base_in_map) for s, u in zip(elsewhere, updates) if u is not None]
    assert max(there) < TRACKED


def test_a_log_that_stops_and_starts_elsewhere_is_one_map(office, drive):
    mapper = Mapper()
    mapped(drive, mapper)
    after = restarted(office.drive(laps=1.0, seed=4)[150:], drive[-1].scan.stamp + 100.0)
    updates = mapped(after, mapper)
    assert max(errors(after, updates, mapper)) < TRACKED


def test_a_trajectory_that_is_never_recognized_stays_beside_the_map(office, state):
    strange = OccupancyGrid(np.full((60, 60), FREE, dtype=np.int8), 0.05, Pose2(0.0, 0.0))
    strange.cells[[0, -1], :] = strange.cells[:, [0, -1]] = OCCUPIED
    room = office._replace(truth=strange)
    mapper = Mapper()
    mapper.resume(state)
    for i in range(20):
        mapper.insert(Pose2(1.0 + 0.05 * i, 1.5, 0.1 * i), room.scan(Pose2(1.0 + 0.05 * i, 1.5, 0.1 * i), i))
    mapper.run_final_optimization()
    assert np.abs(mapper.keyframe_poses[: len(state.poses)] - state.poses).max() < 0.01
    new = mapper.keyframe_poses[len(state.poses) :]
    assert len(new) > 3
    assert new[:, 0].min() > 30.0
    grid = mapper.grid()
    there = grid.points_of(np.argwhere(grid.cells == OCCUPIED))
    assert np.count_nonzero(there[:, 0] > 25.0) > 100


@pytest.mark.parametrize("elapsed, jump", [(0.25, Pose2(-9.0, 3.0, 2.0)), (-500.0, Pose2(0.0, 0.0, 0.0))])
def test_odometry_that_is_reset_and_time_that_jumps_leave_the_robot_where_it_is(office, elapsed, jump):
    drive = office.drive(laps=0.6)
    middle = len(drive) // 2
    later = elapsed - 0.25
    broken = drive[:middle] + [
        s._replace(
            base_in_odom=jump @ s.base_in_odom, scan=dataclasses.replace(s.scan, stamp=s.scan.stamp + later)
        )
        for s in drive[middle:]
    ]
    mapper = Mapper()
    updates = mapped(broken, mapper)
    assert max(errors(broken, updates, mapper)) < TRACKED


def test_a_trajectory_beside_the_map_is_near_it_wherever_it_lies(office):
    mapper, far = Mapper(), Pose2(-9e5, 9e5, 0.8)
    for place, stamp in (
        (Pose2(2.0, 2.0), 10.0),
        (Pose2(14.0, 9.0, 2.0), 5.0),
    ):  # as if switched off and carried
        mapper.insert(far, office.scan(place, stamp))
    assert len(mapper.keyframe_poses) == 2
    assert np.abs(np.diff(mapper.keyframe_poses[:, :2], axis=0)).max() < 100.0


def test_a_clock_jump_does_not_justify_any_jump_of_odometry():
    detector = DiscontinuityDetector()
    assert not detector.is_discontinuous(Pose2(1.0, 0.0, 0.0), 0.0)
    assert not detector.is_discontinuous(Pose2(50.0, 0.0, 0.0), 1e6)
    assert detector.is_discontinuous(Pose2(-9e5, 0.0, 0.0), 2e6)


def test_a_discontinuity_is_distinguished_from_a_drive():
    detector = DiscontinuityDetector()
    driven = [(Pose2(0.5 * i, 0.0, 0.0), 1.0 * i) for i in range(5)]
    assert not any(detector.is_discontinuous(*seen) for seen in driven)
    assert not detector.is_discontinuous(
        Pose2(22.0, 0.0, 0.0), 64.0
    )  # a minute without scans, but odometry went on
    assert detector.is_discontinuous(Pose2(22.0, 0.0, 0.0), 124.0)  # as if switched off, and perhaps carried
    assert detector.is_discontinuous(Pose2(0.0, 0.0, 0.0), 124.1)  # reset
    assert not detector.is_discontinuous(Pose2(9.0, 0.0, 0.0), 150.0)
    assert detector.is_discontinuous(Pose2(0.0, 0.0, 0.0), 180.0)  # switched on again
    assert not detector.is_discontinuous(Pose2(0.1, 0.0, 0.0), 180.2)
    assert detector.is_discontinuous(Pose2(0.1, 0.0, 0.0), 7.0)  # the clock, too


def test_sparsification_keeps_the_constraints():
    rng = np.random.default_rng(0)
    ring = np.array([[5 * math.cos(a), 5 * math.sin(a), wrap(a + 1.5)] for a in np.linspace(0.0, 6.0, 40)])
    poses = [Pose2.from_array(pose) for pose in ring]
    information = np.diag([400.0, 400.0, 2500.0])
    chain = [Edge(i, i + 1, poses[i].inverse() @ poses[i + 1], information) for i in range(39)]
    loops = [Edge(i, 39 - i, poses[i].inverse() @ poses[39 - i], information, is_loop=True) for i in range(4)]
    kept = np.sort(rng.choice(40, 15, replace=False))
    fewer = sparsify(ring, edges_of(*chain, *loops), kept)
    assert chi_squares(ring[kept], fewer) == pytest.approx(np.zeros(len(fewer)), abs=1e-6)
    assert fewer.is_loop.any()
    assert fewer.nodes.max() == 14
    skips = fewer.information[:14][np.diff(kept) > 1]
    assert (skips[:, 0, 0] < 400.0).all()


def test_redundant_keyframes_of_older_sessions_are_removed(office, state):
    size = len(state.poses)
    for seed in (5, 6, 7):
        mapper = Mapper()
        mapper.resume(state, Pose2(2.0, 2.0, 0.0))
        mapped(office.drive(laps=1.0, seed=seed), mapper)
        state = mapper.state()
    assert len(state.poses) < 2.3 * size
    assert len(np.unique(state.sessions)) > 1
    last = state.sessions == state.sessions[-1]
    kept = prune_keyframes(state)
    assert np.array_equal(kept.poses[kept.sessions == state.sessions[-1]], state.poses[last])
    assert len(kept.poses) < 1.3 * size


def test_moved_furniture_is_drawn_at_its_present_place():
    ahead = np.zeros((5, 2), dtype=np.float32)
    near, far = ahead.copy(), ahead.copy()
    near[:, 0], far[:, 0] = 1.02, 2.02
    box = ScanBeams(np.zeros(2), near, np.ones(5, dtype=bool))
    wall = ScanBeams(np.zeros(2), far, np.ones(5, dtype=bool))
    renderer = SessionRenderer(0.1, 0.25)
    renderer.update(Evidence([box] * 9, np.zeros((9, 3)), 9))
    assert value_at(renderer.grid(), 1.02) == OCCUPIED
    renderer.update(Evidence([box] * 9 + [wall], np.zeros((10, 3)), 9))
    assert value_at(renderer.grid(), 1.02) == FREE
    assert value_at(renderer.grid(), 2.02) == OCCUPIED


def value_at(grid, x):
    return grid.cells[
        int((0.0 - grid.origin.y) / grid.resolution), int((x - grid.origin.x) / grid.resolution)
    ]
