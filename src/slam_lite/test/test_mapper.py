import dataclasses
import math

import numpy as np
import pytest

from planar import OCCUPIED, OccupancyGrid, Pose2, wrap
from planar.maps.map_score import score_map
from slam_lite.back_end import without_excess
from slam_lite.config import MapperSettings
from slam_lite.graph.pose_graph import chi_squares
from slam_lite.map_localizer import MapLocalizer
from slam_lite.mapper import Mapper
from slam_lite.rendering import Evidence, SessionRenderer, beams_of

# half a cell of the true grid, from which ranges are cast, plus the drift of the front end in a lap
TRACKED = 0.15


def mapped(drive, settings=MapperSettings(), mapper=None):
    mapper = mapper or Mapper(settings)
    updates = [mapper.insert(observation.base_in_odom, observation.scan) for observation in drive]
    mapper.run_final_optimization()
    return mapper, updates


def worst_error(drive, updates):
    return max(
        update.base_in_map.distance_to(observation.base_in_map)
        for observation, update in zip(drive, updates)
        if update is not None
    )


@pytest.fixture(scope="module")
def drive(office):
    return office.drive()


@pytest.fixture(scope="module")
def mapper(drive):
    return mapped(drive)[0]


def test_the_robot_is_tracked_although_odometry_drifts(drive):
    off = drive[-1].base_in_odom.distance_to(drive[-1].base_in_map)
    assert off > 1.0
    assert worst_error(drive, mapped(drive)[1]) < TRACKED


def test_the_map_is_as_good_as_one_rendered_at_the_true_poses(office, drive, mapper):
    renderer = SessionRenderer(resolution=0.05, occupied_threshold=0.25)
    beams = [beams_of(s.scan, s.scan.range_max, s.scan.range_max) for s in drive]
    renderer.update(Evidence(beams, np.array([s.base_in_map.as_array() for s in drive])))
    best, score = (
        score_map(grid, office.truth, start_in_truth=Pose2(2.0, 2.0, 0.0))
        for grid in (renderer.grid(), mapper.grid())
    )
    # not every niche is visible, so that even the best map misses some walls
    assert score.recall > 0.99 * best.recall
    assert score.precision > 0.95
    assert score.doubled_walls == 0


def test_the_same_drive_gives_the_same_poses_bit_for_bit(drive, mapper):
    again, _ = mapped(drive)
    assert np.array_equal(again.keyframe_poses, mapper.keyframe_poses)


def test_a_loop_is_closed(mapper):
    assert mapper.loop_count > 0


def test_the_final_weights_promise_no_more_than_the_matches_keep(office):
    drive = office.drive(seed=4)
    mapper, updates = mapped(drive)
    true = [s.base_in_map.as_array() for s, update in zip(drive, updates) if update and update.is_keyframe]
    edges = mapper.state().edges
    cautious, final = (
        chi_squares(np.array(true), each)[~edges.is_loop] for each in (edges, without_excess(edges))
    )
    assert 1.5 * cautious.mean() < final.mean() < 3.0
    assert np.mean(final > 9.0) < 0.03


def test_deferred_closures_find_the_same_loops(drive, mapper):
    deferred = Mapper(deferred=True)
    for observation in drive:
        deferred.insert(observation.base_in_odom, observation.scan)
        task = deferred.closure_task()
        if task is not None:
            deferred.apply_closures(task.run())
    assert deferred.loop_count == mapper.loop_count


def test_a_robot_that_stands_still_adds_nothing(office):
    mapper = Mapper()
    here = Pose2(2.0, 2.0, 0.3)
    updates = [mapper.insert(here, office.scan(here, 0.1 * i)) for i in range(50)]
    assert len(mapper.keyframe_poses) == 1
    assert sum(update is not None for update in updates) == 10


def test_without_odometry_the_scans_alone_are_enough(office):
    drive = [s._replace(base_in_odom=Pose2(2.0, 2.0, 0.0)) for s in office.drive(laps=0.5)]
    assert worst_error(drive, mapped(drive)[1]) < TRACKED


def test_a_wheel_slip_is_detected_and_corrected(office):
    drive = office.drive(laps=0.5)
    middle = len(drive) // 2
    slip = Pose2(0.4, -0.3, 0.5)
    slipped = drive[:middle] + [s._replace(base_in_odom=slip @ s.base_in_odom) for s in drive[middle:]]
    _, updates = mapped(slipped)
    assert updates[middle].odometry_chi_square > 100.0
    assert worst_error(slipped, updates) < TRACKED


def test_a_person_walking_ahead_in_a_smooth_corridor_does_not_hold_the_estimate_back(office, drive):
    cells = np.zeros((60, 500), dtype=np.int8)
    cells[[0, -1], :] = cells[:, [0, -1]] = OCCUPIED
    corridor = office._replace(truth=OccupancyGrid(cells, 0.05))
    walk = []
    for i in range(100):
        base_in_map = Pose2(2.0 + 0.1 * i, 1.5, 0.0)
        scan = corridor.scan(base_in_map, 0.2 * i, range_max=40.0)
        scan.ranges[86:95] = np.minimum(scan.ranges[86:95], 2.0)
        base_in_odom = Pose2(2.0 + 0.101 * i, 1.5, 0.0)
        walk.append(drive[0]._replace(scan=scan, base_in_odom=base_in_odom, base_in_map=base_in_map))
    # without odometry the robot would seem to stand still; the person may cost a tenth of the distance
    assert worst_error(walk, mapped(walk)[1]) < 0.1 * 9.9


@pytest.mark.parametrize(
    "laser",
    [
        {"beams": 640, "field_of_view": math.radians(58.0), "range_max": 8.0},
        {"beams": 360, "field_of_view": 2.0 * math.pi * 359.0 / 360.0, "range_max": 12.0},
    ],
    ids=["kinect", "lidar"],
)
def test_other_lasers_map_as_well(office, laser):
    drive = office.drive(turn_error=0.01, **laser)
    mapper, updates = mapped(drive)
    keyframes = [
        observation.base_in_map
        for observation, update in zip(drive, updates)
        if update and update.is_keyframe
    ]
    for keyframe, pose in zip(keyframes, mapper.keyframe_poses):
        assert keyframe.distance_to(Pose2.from_array(pose)) < TRACKED


def test_the_number_of_beams_may_change(office):
    full, half = office.drive(laps=0.5), office.drive(laps=0.5, beams=91)
    drive = [s._replace(scan=pair[i % 2].scan) for i, (s, pair) in enumerate(zip(full, zip(full, half)))]
    assert worst_error(drive, mapped(drive)[1]) < TRACKED


def test_an_upside_down_laser_maps_as_well(office):
    drive = [
        s._replace(scan=dataclasses.replace(s.scan, ranges=s.scan.ranges[::-1].copy(), upside_down=True))
        for s in office.drive(laps=0.4)
    ]
    assert worst_error(drive, mapped(drive)[1]) < TRACKED


def test_scans_without_returns_are_tolerated(office):
    drive = office.drive(laps=0.4)
    blind = dataclasses.replace(drive[20].scan, ranges=np.full(181, np.nan, dtype=np.float32))
    drive[20:24] = [s._replace(scan=dataclasses.replace(blind, stamp=s.scan.stamp)) for s in drive[20:24]]
    assert worst_error(drive, mapped(drive)[1]) < TRACKED


def test_mapping_resumes_from_a_saved_state(office, mapper):
    resumed = Mapper()
    resumed.resume(mapper.state(), Pose2(2.3, 1.8, 0.1))
    restarted = Pose2(5.0, 5.0, 1.0)
    drive = [s._replace(base_in_odom=restarted @ s.base_in_odom) for s in office.drive(laps=0.5, seed=1)]
    mapped(drive, mapper=resumed)
    assert len(resumed.keyframe_poses) > len(mapper.keyframe_poses)
    score = score_map(resumed.grid(), office.truth, start_in_truth=Pose2(2.0, 2.0, 0.0))
    assert score.precision > 0.95
    assert score.doubled_walls == 0


def test_a_localizer_tracks_in_a_finished_map_and_leaves_it_unchanged(office, mapper):
    state = mapper.state()
    poses = state.poses.copy()
    drive = office.drive(laps=0.5, seed=2)
    localizer = MapLocalizer(MapperSettings(), state, Pose2(2.2, 1.9, 0.1))
    updates = [localizer.insert(s.base_in_odom, s.scan) for s in drive]
    assert worst_error(drive[5:], updates[5:]) < TRACKED
    assert np.array_equal(state.poses, poses)


def test_odom_in_map_transforms_odometry_to_the_estimate(drive):
    _, updates = mapped(drive[:40])
    for observation, update in zip(drive, updates):
        there = update.odom_in_map @ observation.base_in_odom
        assert there.distance_to(update.base_in_map) < 1e-9
        assert abs(wrap(there.yaw - update.base_in_map.yaw)) < 1e-9


def test_no_wall_is_drawn_where_no_beam_ended(office):
    mapper = Mapper()
    here = Pose2(2.0, 2.0, 0.0)
    mapper.insert(here, office.scan(here, range_max=1.05))
    grid = mapper.grid()
    distances = np.hypot(*(grid.points_of(np.argwhere(grid.cells == OCCUPIED)) - [2.0, 2.0]).T)
    assert distances.max() < 1.05


def test_circles_of_readings_without_return_are_removed_once_the_constant_is_known(office):
    """It is known after some 200 readings; keyframes and maps from before have them as obstacles."""
    mapper, renderer = Mapper(), SessionRenderer(0.05, 0.25)
    farthest = []
    for observation in office.drive(laps=0.3, range_max=80.0):
        ranges = observation.scan.ranges.copy()
        ranges[:20] = 79.9
        mapper.insert(observation.base_in_odom, dataclasses.replace(observation.scan, ranges=ranges))
        renderer.update(mapper.evidence())
        rows, cols = np.nonzero(renderer.grid().cells == OCCUPIED)
        farthest.append(0.05 * max(np.ptp(rows), np.ptp(cols)))
    assert max(farthest) > 60.0
    assert farthest[-1] < 20.0
    assert np.array_equal(renderer.grid().cells, mapper.grid().cells)
    assert all(np.abs(cloud.points_xy).max() < 20.0 for cloud in mapper.state().clouds)
