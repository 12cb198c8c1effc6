"""Movers are found with their velocity; what stands still is none, however the robot moves."""

import math

import numpy as np
import pytest
from robot_in_picture import PERSON_RADIUS, room, scan_with_people, two_rooms, with_block

from move_base_lite.costmap import sighting_of_scan
from move_base_lite.people import Movers
from planar import Pose2
from planar.geometry.ray_casting import cast_rays

PERIOD = 0.1


def watch(grid, base_at, person_at, seconds, seed=0, radius=PERSON_RADIUS):
    """[(stamp, rows)]: what a robot at ``base_at(t)`` finds moving while a person is at ``person_at(t)``."""
    rng, movers, found = np.random.default_rng(seed), Movers(), []
    for step in range(round(seconds / PERIOD)):
        stamp = step * PERIOD
        base, person = base_at(stamp), person_at(stamp)
        scan = scan_with_people(grid, base, stamp, [person] if person else [], rng, radius)
        movers.look(base, sighting_of_scan("scan", scan))
        found.append((stamp, movers.at(stamp)))
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


def test_who_comes_towards_a_robot_that_has_just_started_is_found_in_time():
    found = watch(room(8.0, 4.0), lambda t: Pose2(1.0, 2.0), lambda t: (4.0 - 1.2 * t, 2.0), 1.0)
    first = next(stamp for stamp, rows in found if len(rows))
    assert first <= 0.7


def test_nobody_moves_while_the_robot_drives_past_doors_and_boxes():
    grid = with_block(with_block(two_rooms(0.9), 1.2, 2.6, 1.5, 2.9), 4.4, 1.2, 4.6, 1.4)
    found = watch(grid, lambda t: Pose2(0.6 + 0.5 * t, 2.0, 0.3 * math.sin(t)), lambda t: None, 9.0)
    assert [len(rows) for _, rows in found] == [0] * len(found)


def test_a_person_who_has_stopped_is_no_mover_any_more():
    found = watch(room(8.0, 4.0), lambda t: Pose2(1.0, 2.0), lambda t: (3.0, 1.0 + 0.6 * min(t, 2.0)), 4.0)
    assert len(found[19][1]) == 1
    assert not any(len(rows) for stamp, rows in found if stamp > 3.0)


def test_a_jump_back_of_time_forgets_everybody():
    movers, rng = Movers(), np.random.default_rng(0)
    for step in range(20):
        scan = scan_with_people(
            room(8.0, 4.0), Pose2(1.0, 2.0), step * PERIOD, [(3.0, 1.0 + 0.06 * step)], rng
        )
        movers.look(Pose2(1.0, 2.0), sighting_of_scan("scan", scan))
    assert len(movers.at(2.0)) == 1
    movers.look(
        Pose2(1.0, 2.0),
        sighting_of_scan("scan", scan_with_people(room(8.0, 4.0), Pose2(1.0, 2.0), 0.0, [], rng)),
    )
    assert len(movers.at(0.0)) == 0


def test_who_walks_or_has_just_stopped_is_left_out_of_what_lasts():
    movers, rng, grid, base = Movers(), np.random.default_rng(0), room(8.0, 4.0), Pose2(1.0, 2.0)
    for step in range(80):
        person_xy = (3.0, 1.0 + 0.06 * min(step, 20))
        sighting = sighting_of_scan("scan", scan_with_people(grid, base, step * PERIOD, [person_xy], rng))
        gone = np.isnan(movers.look(base, sighting).ranges)
        on_person = sighting.ranges < cast_rays(grid, base, sighting.angles, sighting.range_max) - 0.1
        if 15 <= step < 55:
            assert (gone == on_person).all()
    assert not gone.any()
