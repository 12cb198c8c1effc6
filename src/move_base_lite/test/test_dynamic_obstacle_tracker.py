"""Dynamic obstacles are tracked with their velocity; static ones never are, however the robot moves."""

import math

import numpy as np
import pytest
from robot_in_picture import PERSON_RADIUS, room, scan_with_people, two_rooms, with_block

from move_base_lite.costmap import observation_from_scan
from move_base_lite.dynamic_obstacles import DynamicObstacleTracker, TrackerSettings
from planar import Pose2
from planar.geometry.ray_casting import cast_rays

PERIOD = 0.1


def watch(grid, base_at, person_at, seconds, seed=0, radius=PERSON_RADIUS, settings=TrackerSettings()):
    """[(stamp, rows)]: what a robot at ``base_at(t)`` finds moving while a person is at ``person_at(t)``,
    or several are.
    """
    rng, tracker, found = np.random.default_rng(seed), DynamicObstacleTracker(), []
    for step in range(round(seconds / PERIOD)):
        stamp = step * PERIOD
        base, person = base_at(stamp), person_at(stamp)
        people = person if isinstance(person, list) else [person] if person else []
        scan = scan_with_people(grid, base, stamp, people, rng, radius)
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

    found = watch(room(8.0, 4.0), lambda t: Pose2(1.0 + robot_speed * t, 2.0), person_at, 3.0)
    for stamp, rows in found[15:]:
        assert len(rows) == 1
        x, y, *estimate, radius = rows[0]
        assert math.dist((x, y), person_at(stamp)) < 0.15
        assert math.dist(estimate, velocity) < 0.2
        assert radius == pytest.approx(PERSON_RADIUS, abs=0.06)


def test_a_thing_a_metre_wide_that_moves_is_tracked():
    def cart_at(t):
        return 3.0, 0.8 + 0.9 * t

    found = watch(room(8.0, 5.0), lambda t: Pose2(1.0, 2.5), cart_at, 3.0, radius=0.5)
    for stamp, rows in found[15:]:
        ((x, y, *estimate, radius),) = rows
        assert math.dist((x, y), cart_at(stamp)) < 0.25
        assert math.dist(estimate, (0.0, 0.9)) < 0.25
        assert radius == pytest.approx(0.5, abs=0.15)


def test_what_passes_close_by_is_as_wide_as_from_afar():
    def cart_at(t):
        return 1.9, 0.0 + 1.0 * t

    found = watch(room(8.0, 8.0), lambda t: Pose2(1.0, 4.0), cart_at, 7.0, radius=0.5)
    widths = [rows[0][4] for _, rows in found[20:] if len(rows)]
    assert len(widths) > 40
    assert 0.43 < min(widths) <= max(widths) < 0.57


def test_posts_that_hide_each_other_do_not_move():
    rng = np.random.default_rng(5)
    posts = [xy for xy in rng.uniform((1.0, 0.5), (11.0, 7.5), (90, 2)) if abs(xy[1] - 4.0) > 0.6]
    settings = TrackerSettings(9.0, True)
    found = watch(
        room(12.0, 8.0),
        lambda t: Pose2(1.0 + 1.5 * t, 4.0),
        lambda t: posts,
        5.0,
        radius=0.08,
        settings=settings,
    )
    moving = [len(rows) for _, rows in found]
    print(f"{np.mean(moving):.2f} a look")
    assert np.mean(moving) < 0.2


def test_who_comes_towards_a_robot_that_has_just_started_is_found_in_time():
    found = watch(room(8.0, 4.0), lambda t: Pose2(1.0, 2.0), lambda t: (4.0 - 1.2 * t, 2.0), 1.0)
    first = next(stamp for stamp, rows in found if len(rows))
    assert first <= 0.7


def nearest_to(rows, place):
    """How far, m, the nearest of what was found is from a place."""
    return min((math.dist(row[:2], place) for row in rows), default=math.inf)


@pytest.mark.parametrize("seed", range(10))
def test_who_comes_out_from_behind_somebody_is_seen_to_move_if_all_is_watched(seed):
    def hidden_at(t):  # behind the one who stands; in view as a whole after 1.83 s
        return 4.2, 2.0 + 1.5 * max(t - 1.0, 0.0)

    found = watch(
        room(8.0, 8.0),
        lambda t: Pose2(1.0, 2.0),
        lambda t: [(2.6, 2.0), hidden_at(t)],
        3.0,
        seed,
        0.4,
        TrackerSettings(9.0, track_appearing=True),
    )
    assert min(t for t, rows in found if nearest_to(rows, hidden_at(t)) < 0.3) <= 2.0


def test_who_is_far_off_is_found_within_the_reach_that_is_asked_for():
    def person_at(t):
        return 7.0, 1.0 + 0.8 * t

    for settings, is_found in ((TrackerSettings(), False), (TrackerSettings(9.0), True)):
        found = watch(room(9.0, 5.0), lambda t: Pose2(1.0, 2.0), person_at, 2.5, 0, 0.4, settings)
        assert any(len(rows) for _, rows in found) == is_found


def test_two_who_walk_shoulder_to_shoulder_are_two():
    def pair_at(t):
        return [(3.5 - 0.6 * t, 1.55), (3.5 - 0.6 * t, 2.45)]

    found = watch(room(9.0, 4.0), lambda t: Pose2(1.0, 2.0), pair_at, 2.0, 0, 0.45)
    stamp, rows = found[-1]
    assert [nearest_to(rows, place) < 0.2 for place in pair_at(stamp)] == [True, True]


def test_who_turns_round_is_expected_on_the_way_back_half_a_second_later():
    def person_at(t):
        return 3.0, 1.0 + 1.2 * min(t, 2.0) - 1.2 * max(t - 2.0, 0.0)

    found = watch(room(8.0, 5.0), lambda t: Pose2(1.0, 2.0), person_at, 3.0, 0, 0.3)
    for stamp, rows in found:
        if stamp > 2.55:
            assert rows[0][3] == pytest.approx(-1.2, abs=0.4)


def test_who_walks_behind_something_is_still_expected_there():
    grid = with_block(room(8.0, 5.0), 2.6, 1.8, 2.8, 3.2)

    def person_at(t):
        return 3.6, 0.4 + 0.8 * t

    found = watch(grid, lambda t: Pose2(1.0, 2.5), person_at, 3.2)
    hidden = [(stamp, rows) for stamp, rows in found if 1.7 < person_at(stamp)[1] < 2.6]
    assert hidden
    for stamp, rows in hidden:
        assert nearest_to(rows, person_at(stamp)) < 0.3


def test_nobody_moves_while_the_robot_drives_past_doors_and_boxes():
    grid = with_block(with_block(two_rooms(0.9), 1.2, 2.6, 1.5, 2.9), 4.4, 1.2, 4.6, 1.4)
    found = watch(grid, lambda t: Pose2(0.6 + 0.5 * t, 2.0, 0.3 * math.sin(t)), lambda t: None, 9.0)
    assert [len(rows) for _, rows in found] == [0] * len(found)


def test_a_person_who_has_stopped_is_no_mover_any_more():
    found = watch(room(8.0, 4.0), lambda t: Pose2(1.0, 2.0), lambda t: (3.0, 1.0 + 0.6 * min(t, 2.0)), 4.0)
    assert len(found[19][1]) == 1
    assert not any(len(rows) for stamp, rows in found if stamp > 3.0)


def test_a_jump_back_of_time_forgets_everybody():
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


def test_who_walks_or_has_just_stopped_is_left_out_of_what_lasts():
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
