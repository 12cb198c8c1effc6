"""Ways around obstacles to a dock."""

import math

import numpy as np
import pytest

from auto_docking_lite.detours import free_legs
from auto_docking_lite.motion import TOUCH
from planar import Pose2

RADIUS, STEP = 0.18, 0.02


def wall(x0, y0, x1, y1):
    """Return points (N, 2) on a straight wall."""
    count = int(math.hypot(x1 - x0, y1 - y0) / STEP) + 1
    return np.column_stack((np.linspace(x0, x1, count), np.linspace(y0, y1, count)))


def drive(obstacles, start, end, steps=400):
    """Drive along the legs, decided afresh every few centimetres; return the positions (N, 2)."""
    track = [(start.x, start.y)]
    for _ in range(steps):
        legs = free_legs(obstacles, start, end, RADIUS)
        if legs is None or start.distance_to(end) < STEP:
            break
        heading = math.atan2(legs[0].y - start.y, legs[0].x - start.x)
        step = min(2.0 * STEP, start.distance_to(legs[0]))
        start = Pose2(start.x + step * math.cos(heading), start.y + step * math.sin(heading))
        track.append((start.x, start.y))
    return np.array(track)


def gap(obstacles, track):
    """Return the smallest distance between obstacles and a track [m]."""
    return np.hypot(*(obstacles[:, None, :] - track[None, :, :]).transpose(2, 0, 1)).min()


def test_without_obstacles_the_way_is_straight():
    assert free_legs(np.empty((0, 2)), Pose2(), Pose2(2.0), RADIUS) == (Pose2(2.0),)


def test_a_way_out_of_a_pocket_has_several_legs():
    pocket = np.vstack((wall(0.4, -0.6, 0.4, 0.6), wall(0.4, 0.6, -0.8, 0.6), wall(0.4, -0.6, -0.8, -0.6)))
    end = Pose2(1.2, 0.0)
    track = drive(pocket, Pose2(), end)
    assert np.hypot(*(track[-1] - (end.x, end.y))) < 0.05
    assert gap(pocket, track) > RADIUS


@pytest.mark.parametrize("width", [0.46, 0.5, 0.6])
@pytest.mark.parametrize("y", [0.0, 0.013, 0.027, 0.041])
def test_a_gap_little_wider_than_the_robot_is_passed(width, y):
    half = width / 2.0
    walls = np.vstack((wall(1.0, y - 1.6, 1.0, y - half), wall(1.0, y + half, 1.0, y + 1.6)))
    track = drive(walls, Pose2(0.0, 1.0), Pose2(2.0, -1.0))
    assert track[-1, 0] > 1.9 and gap(walls, track) > RADIUS


def test_a_gap_narrower_than_the_robot_is_no_way():
    walls = np.vstack((wall(1.0, -4.0, 1.0, -0.17), wall(1.0, 0.17, 1.0, 4.0)))
    assert free_legs(walls, Pose2(), Pose2(2.0), RADIUS) is None


def test_a_target_in_an_obstacle_is_not_reached():
    assert free_legs(wall(1.9, -0.1, 1.9, 0.1), Pose2(), Pose2(2.0), RADIUS) is None


def test_a_target_close_to_an_obstacle_is_reached():
    target, walls = Pose2(1.0, 0.0), np.vstack((wall(0.5, -0.1, 0.5, 0.1), wall(0.8, 0.2, 1.2, 0.2)))
    track = drive(walls, Pose2(), target)
    assert np.hypot(*(track[-1] - (1.0, 0.0))) < 0.05


def test_a_robot_that_touches_an_obstacle_leaves_it():
    walls = wall(0.178, -0.3, 0.178, 0.3)
    track = drive(walls, Pose2(), Pose2(1.0, 0.0))
    assert track[-1, 0] > 0.95 and gap(walls, track) > 0.178 - 1.2 * TOUCH
