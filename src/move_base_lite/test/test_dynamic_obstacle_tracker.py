"""Dynamic obstacles are tracked with their velocity; static ones never are, however the robot moves."""

import math
from dataclasses import replace

import numpy as np
import pytest
from robot_in_picture import PERSON_RADIUS, room, scan_with_people, two_rooms, with_block

from move_base_lite.costmap import observation_from_scan
from move_base_lite.dynamic_obstacles import DynamicObstacleTracker, TrackerSettings
from move_base_lite.dynamic_obstacles.scan_segments import ScanSegment, ScanSnapshot, segments_of
from move_base_lite.dynamic_obstacles.track import MAX_SPEED, MOVING_MEMORY, Track
from planar import Pose2
from planar.geometry.ray_casting import cast_rays

PERIOD = 0.1


def track(
    grid,
    base_at,
    person_at,
    seconds,
    seed=0,
    radius=PERSON_RADIUS,
    settings=TrackerSettings(),
    half_view=None,
):
    """[(stamp, rows)] of the obstacles that a robot at ``base_at(t)`` tracks; ``person_at(t)``: a position, a
    list of positions or None; ``half_view``: half the field of view in degrees, if it is no full circle.
    """
    rng, tracker, found = np.random.default_rng(seed), DynamicObstacleTracker(), []
    for step in range(round(seconds / PERIOD)):
        stamp = step * PERIOD
        base, person = base_at(stamp), person_at(stamp)
        people = person if isinstance(person, list) else [person] if person else []
        scan = scan_with_people(grid, base, stamp, people, rng, radius)
        if half_view is not None:
            ahead = np.roll(scan.ranges, half_view)[: 2 * half_view + 1]
            scan = replace(scan, angle_min=-math.radians(half_view), ranges=ahead)
        tracker.update(base, observation_from_scan("scan", scan), settings)
        found.append((stamp, tracker.obstacles_at(stamp)))
    return found


@pytest.mark.parametrize("robot_speed", [0.0, 0.5])
@pytest.mark.parametrize("velocity", [(0.0, 0.6), (-0.5, 0.0), (0.3, -0.3)])
def test_a_walking_person_is_tracked(robot_speed, velocity):
    vx, vy = velocity
    start = (3.5 - 1.5 * vx, 2.0 - 1.5 * vy)

    def person_at(t):
        return start[0] + vx * t, start[1] + vy * t

    found = track(room(8.0, 4.0), lambda t: Pose2(1.0 + robot_speed * t, 2.0), person_at, 3.0)
    for stamp, rows in found[15:]:
        assert len(rows) == 1
        x, y, *estimate, radius = rows[0]
        assert math.dist((x, y), person_at(stamp)) < 0.15
        assert math.dist(estimate, velocity) < 0.2
        assert radius == pytest.approx(PERSON_RADIUS, abs=0.06)


def test_a_moving_object_one_metre_wide_is_tracked():
    def cart_at(t):
        return 3.0, 0.8 + 0.9 * t

    found = track(room(8.0, 5.0), lambda t: Pose2(1.0, 2.5), cart_at, 3.0, radius=0.5)
    for stamp, rows in found[15:]:
        ((x, y, *estimate, radius),) = rows
        assert math.dist((x, y), cart_at(stamp)) < 0.25
        assert math.dist(estimate, (0.0, 0.9)) < 0.25
        assert radius == pytest.approx(0.5, abs=0.15)


def test_an_object_nearby_has_the_same_radius_as_far_away():
    def cart_at(t):
        return 1.9, 0.0 + 1.0 * t

    found = track(room(8.0, 8.0), lambda t: Pose2(1.0, 4.0), cart_at, 7.0, radius=0.5)
    widths = [rows[0][4] for _, rows in found[20:] if len(rows)]
    assert len(widths) > 40
    assert 0.43 < min(widths) <= max(widths) < 0.57


def test_posts_that_occlude_each_other_do_not_move():
    rng = np.random.default_rng(5)
    posts = [xy for xy in rng.uniform((1.0, 0.5), (11.0, 7.5), (90, 2)) if abs(xy[1] - 4.0) > 0.6]
    settings = TrackerSettings(9.0, True)
    found = track(
        room(12.0, 8.0),
        lambda t: Pose2(1.0 + 1.5 * t, 4.0),
        lambda t: posts,
        5.0,
        radius=0.08,
        settings=settings,
    )
    moving = [len(rows) for _, rows in found]
    print(f"{np.mean(moving):.2f} per scan")
    assert np.mean(moving) < 0.2


def test_a_person_approaching_a_robot_that_just_started_is_detected_in_time():
    found = track(room(8.0, 4.0), lambda t: Pose2(1.0, 2.0), lambda t: (4.0 - 1.2 * t, 2.0), 1.0)
    first = next(stamp for stamp, rows in found if len(rows))
    assert first <= 0.7


def nearest_to(rows, place):
    """Distance from a position to the nearest obstacle [m]."""
    return min((math.dist(row[:2], place) for row in rows), default=math.inf)


@pytest.mark.parametrize("seed", range(10))
def test_a_person_appearing_from_behind_another_is_tracked_with_track_appearing(seed):
    def hidden_at(t):  # behind the standing person; fully visible after 1.83 s
        return 4.2, 2.0 + 1.5 * max(t - 1.0, 0.0)

    found = track(
        room(8.0, 8.0),
        lambda t: Pose2(1.0, 2.0),
        lambda t: [(2.6, 2.0), hidden_at(t)],
        3.0,
        seed,
        0.4,
        TrackerSettings(9.0, track_appearing=True),
    )
    assert min(t for t, rows in found if nearest_to(rows, hidden_at(t)) < 0.3) <= 2.0


def test_a_distant_person_is_tracked_within_max_range():
    def person_at(t):
        return 7.0, 1.0 + 0.8 * t

    for settings, is_found in ((TrackerSettings(), False), (TrackerSettings(9.0), True)):
        found = track(room(9.0, 5.0), lambda t: Pose2(1.0, 2.0), person_at, 2.5, 0, 0.4, settings)
        assert any(len(rows) for _, rows in found) == is_found


def test_two_people_walking_shoulder_to_shoulder_are_two_tracks():
    def pair_at(t):
        return [(3.5 - 0.6 * t, 1.55), (3.5 - 0.6 * t, 2.45)]

    found = track(room(9.0, 4.0), lambda t: Pose2(1.0, 2.0), pair_at, 2.0, 0, 0.45)
    stamp, rows = found[-1]
    assert [nearest_to(rows, place) < 0.2 for place in pair_at(stamp)] == [True, True]


def test_a_reversal_is_predicted_half_a_second_later():
    def person_at(t):
        return 3.0, 1.0 + 1.2 * min(t, 2.0) - 1.2 * max(t - 2.0, 0.0)

    found = track(room(8.0, 5.0), lambda t: Pose2(1.0, 2.0), person_at, 3.0, 0, 0.3)
    for stamp, rows in found:
        if stamp > 2.55:
            assert rows[0][3] == pytest.approx(-1.2, abs=0.4)


@pytest.mark.parametrize("seed", range(5))
def test_a_sudden_reversal_is_known_from_the_next_scan(seed):
    def cart_at(t):
        return 4.0, 2.0 + 1.6 * min(t, 1.5) - 1.6 * max(t - 1.5, 0.0)

    found = track(room(9.0, 8.0), lambda t: Pose2(1.0, 4.0), cart_at, 2.5, seed, 0.5, TrackerSettings(9.0))
    for stamp, rows in found:
        if stamp > 1.55:
            assert rows[0][3] == pytest.approx(-1.6, abs=0.4)


@pytest.mark.parametrize("seed", range(5))
def test_a_person_who_stops_stays_known_and_moves_from_the_second_scan_after_starting_again(seed):
    stop, start, speed = 1.5, 3.0, 1.6

    def person_at(t):
        return 4.0, 2.0 + speed * (min(t, stop) + max(t - start, 0.0))

    found = track(room(9.0, 9.0), lambda t: Pose2(1.0, 4.5), person_at, 4.0, seed, 0.4, TrackerSettings(9.0))
    for stamp, rows in found[10:]:
        assert nearest_to(rows, person_at(stamp)) < 0.15
        if stop + 0.45 < stamp < start + 0.05:
            assert abs(rows[0][3]) < 0.3
        if stamp > start + 1.5 * PERIOD:
            assert rows[0][3] == pytest.approx(speed, abs=0.4)


def test_a_person_who_leaves_the_field_of_view_keeps_radius_and_velocity():
    def person_at(t):  # at 135 degrees after 4.5 s
        return 7.0 - 1.0 * t, 5.5

    found = track(
        room(9.0, 9.0), lambda t: Pose2(4.0, 4.0), person_at, 5.8, 0, 0.5, TrackerSettings(9.0), half_view=135
    )
    for stamp, rows in found[10:]:
        ((x, y, v_x, v_y, radius),) = rows
        assert math.dist((x, y), person_at(stamp)) < 0.15
        assert math.dist((v_x, v_y), (-1.0, 0.0)) < 0.25
        assert radius == pytest.approx(0.5, abs=0.07)


def test_two_that_overlap_are_two_segments_whose_outlines_are_known_in_part_only():
    people = [(3.0, 2.65), (3.0, 3.35)]
    scan = scan_with_people(
        room(9.0, 6.0), Pose2(1.0, 3.0), 0.0, people, np.random.default_rng(0), radius=0.45
    )
    segments = segments_of(ScanSnapshot(Pose2(1.0, 3.0), observation_from_scan("scan", scan), 8.0))
    pair = [each for each in segments if min(math.dist(each.centre_xy, xy) for xy in people) < 0.3]
    assert [segment.is_occluded for segment in pair] == [True, True]


def test_a_radius_that_was_seen_often_grows_slowly():
    def segment(radius):
        points_xy = np.array([[3.0 - radius, 1.0], [3.0, 1.0 - radius], [3.0, 1.0 + radius]])
        return ScanSegment(points_xy, np.array([3.0, 1.0]), radius, False)

    track = Track(segment(0.5), 0.0)
    for step in range(1, 41):
        track.predict(step * PERIOD)
        track.correct(segment(0.5 if step < 20 else 0.8), True, True)
    assert 0.5 < track.state_at(4.0)[4] < 0.6


def test_a_person_who_has_stood_for_a_while_is_static():
    def person_at(t):
        return 3.0, 1.0 + 1.2 * min(t, 2.0)

    settings = TrackerSettings(9.0)
    found = track(room(8.0, 5.0), lambda t: Pose2(1.0, 2.0), person_at, 7.5, 0, 0.3, settings)
    assert all(len(rows) == 1 for stamp, rows in found if 1.0 < stamp < 2.0 + MOVING_MEMORY)
    assert not any(len(rows) for stamp, rows in found if stamp > 2.6 + MOVING_MEMORY)


def test_an_occluded_person_is_still_predicted():
    grid = with_block(room(8.0, 5.0), 2.6, 1.8, 2.8, 3.2)

    def person_at(t):
        return 3.6, 0.4 + 0.8 * t

    found = track(grid, lambda t: Pose2(1.0, 2.5), person_at, 3.2)
    hidden = [(stamp, rows) for stamp, rows in found if 1.7 < person_at(stamp)[1] < 2.6]
    assert hidden
    for stamp, rows in hidden:
        assert nearest_to(rows, person_at(stamp)) < 0.3


def test_a_partly_hidden_object_keeps_its_radius():
    grid = with_block(room(8.0, 5.0), 2.6, 2.5, 2.8, 3.6)

    def cart_at(t):
        return 3.6, 0.6 + 0.6 * t

    found = track(grid, lambda t: Pose2(1.0, 2.5), cart_at, 4.0, radius=0.5)
    half_hidden = [(stamp, rows) for stamp, rows in found if 2.2 < cart_at(stamp)[1] < 2.9]
    assert half_hidden
    for stamp, rows in half_hidden:
        ((x, y, _, _, radius),) = rows
        assert radius > 0.45
        assert math.dist((x, y), cart_at(stamp)) < 0.15


@pytest.mark.parametrize("seed", range(5))
def test_two_that_overlap_in_the_scan_keep_their_velocities(seed):
    def pair_at(t):  # nearest to each other after 2.2 s, one segment then
        return [(3.6, 0.8 + 1.0 * t), (4.0, 5.2 - 1.0 * t)]

    found = track(
        room(9.0, 6.0), lambda t: Pose2(1.0, 3.0), pair_at, 3.6, seed, 0.5, TrackerSettings(9.0, True)
    )
    for stamp, rows in found[15:]:
        assert nearest_to(rows, pair_at(stamp)[0]) < 0.25
        nearest = min(rows, key=lambda row: math.dist(row[:2], pair_at(stamp)[0]))
        assert math.dist(nearest[2:4], (0.0, 1.0)) < 0.5
        assert nearest[4] == pytest.approx(0.5, abs=0.08)


def test_an_object_seen_in_part_gets_its_size_when_all_of_it_is_seen():
    grid = with_block(room(8.0, 5.0), 2.6, 2.5, 2.8, 4.9)

    def cart_at(t):  # comes out from behind the block
        return 3.6, 4.2 - 0.8 * t

    found = track(
        grid, lambda t: Pose2(1.0, 2.5), cart_at, 4.0, radius=0.5, settings=TrackerSettings(9.0, True)
    )
    in_view = [(stamp, rows) for stamp, rows in found if cart_at(stamp)[1] < 1.9]
    assert in_view
    for stamp, rows in in_view:
        ((x, y, _, _, radius),) = rows
        assert radius == pytest.approx(0.5, abs=0.07)
        assert math.dist((x, y), cart_at(stamp)) < 0.15


def test_a_cart_that_recedes_from_where_it_was_first_seen_moves():
    def cart_at(t):  # hides the space that it enters
        return 2.5 + 0.8 * t, 2.0

    found = track(room(9.0, 4.0), lambda t: Pose2(1.0, 2.0), cart_at, 2.0, 0, 0.5, TrackerSettings(9.0, True))
    for stamp, rows in found:
        if stamp > 1.2:
            assert nearest_to(rows, cart_at(stamp)) < 0.2


def test_a_wrong_match_does_not_make_a_track_faster_than_an_object_can_be():
    def segment_at(x):
        points_xy = np.array([[x - 0.1, 1.0], [x, 0.9], [x + 0.1, 1.0]])
        return ScanSegment(points_xy, np.array([x, 1.0]), 0.1, False)

    tracked = Track(segment_at(1.0), 0.0)
    for step in range(1, 6):
        tracked.predict(0.05 * step)
        tracked.correct(segment_at(1.0 + 0.5 * step), True, True)
    assert math.hypot(*tracked.state_at(0.25)[2:4]) < MAX_SPEED + 1e-6


def test_doors_and_boxes_do_not_move_while_the_robot_drives_past():
    grid = with_block(with_block(two_rooms(0.9), 1.2, 2.6, 1.5, 2.9), 4.4, 1.2, 4.6, 1.4)
    found = track(grid, lambda t: Pose2(0.6 + 0.5 * t, 2.0, 0.3 * math.sin(t)), lambda t: None, 9.0)
    assert [len(rows) for _, rows in found] == [0] * len(found)


def test_a_jump_back_of_time_resets_the_tracker():
    tracker, rng = DynamicObstacleTracker(), np.random.default_rng(0)
    for step in range(20):
        scan = scan_with_people(
            room(8.0, 4.0), Pose2(1.0, 2.0), step * PERIOD, [(3.0, 1.0 + 0.06 * step)], rng
        )
        tracker.update(Pose2(1.0, 2.0), observation_from_scan("scan", scan))
    assert len(tracker.obstacles_at(2.0)) == 1
    tracker.update(
        Pose2(1.0, 2.0),
        observation_from_scan("scan", scan_with_people(room(8.0, 4.0), Pose2(1.0, 2.0), 0.0, [], rng)),
    )
    assert len(tracker.obstacles_at(0.0)) == 0


def test_beams_on_a_person_who_walks_or_has_just_stopped_are_removed():
    tracker, rng, grid, base = (
        DynamicObstacleTracker(),
        np.random.default_rng(0),
        room(8.0, 4.0),
        Pose2(1.0, 2.0),
    )
    for step in range(80):
        person_xy = (3.0, 1.0 + 0.06 * min(step, 20))
        observation = observation_from_scan(
            "scan", scan_with_people(grid, base, step * PERIOD, [person_xy], rng)
        )
        gone = np.isnan(tracker.update(base, observation).ranges)
        on_person = (
            observation.ranges < cast_rays(grid, base, observation.angles, observation.range_max) - 0.1
        )
        if 15 <= step < 55:
            assert (gone == on_person).all()
    assert not gone.any()
