"""Beams cast in a cross-section of the world."""

import math

import numpy as np
import pytest

from planar import Pose2, grid_from_picture
from planar.geometry.ray_casting import cast_rays
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.geometry.shapes import Box, Cylinder, Sphere
from sim_bridge.views.section import CrossSection, cast_beams
from sim_bridge.world import Body, Collision

SQUARE = np.array([[1, -1, 1, 1], [1, 1, -1, 1], [-1, 1, -1, -1], [-1, -1, 1, -1]], dtype=float)


def body(shape, pose, mass=None, name="m::l", laser_retro=0.0, **more):
    return Body(name, pose, (Collision(shape, np.eye(4), laser_retro=laser_retro),), mass, **more)


def ranges_at(section, count=4, max_range=10.0, pose_of=None):
    return cast_beams(section.segments(pose_of), 0.0, 0.0, 0.0, 2.0 * math.pi / count, count, max_range)[0]


def test_the_walls_of_a_square_are_met_at_their_distance():
    ranges, _ = cast_beams(SQUARE, 0.25, 0.0, -math.pi, math.pi / 2.0, 4, 10.0)
    assert ranges == pytest.approx([1.25, 1.0, 0.75, 1.0])


@pytest.mark.parametrize("yaw", np.linspace(-7.0, 7.0, 8))
def test_every_beam_meets_a_closed_room_whatever_the_heading(yaw):
    ranges, _ = cast_beams(SQUARE, 0.3, -0.4, yaw, 2.0 * math.pi / 360, 360, 10.0)
    angles = yaw + 2.0 * math.pi / 360 * np.arange(360)
    ends = np.array([[0.3], [-0.4]]) + ranges * np.array([np.cos(angles), np.sin(angles)])
    assert np.abs(ends).max(axis=0) == pytest.approx(np.ones(360))


def test_nothing_is_measured_beyond_the_maximum_range():
    assert np.isinf(cast_beams(SQUARE, 0.0, 0.0, 0.0, 0.1, 10, 0.9)[0]).all()


def test_beams_agree_with_those_cast_through_a_fine_grid():
    grid = grid_from_picture("#########\n#.......#\n#..##...#\n#.......#\n#########", 0.5)
    rows, cols = np.nonzero(grid.cells)
    section = CrossSection(height=0.3)
    for index, (row, col) in enumerate(zip(rows, cols)):
        middle = pose3((col + 0.5) * 0.5, (row + 0.5) * 0.5, 0.5)
        section.add(body(Box((0.5, 0.5, 1.0)), middle, name=f"{index}::l"))
    at = Pose2(1.1, 0.83, 0.4)
    beams, _ = cast_beams(section.segments(None), at.x, at.y, at.yaw, math.radians(1.0), 360, 10.0)
    assert beams == pytest.approx(cast_rays(grid, at, np.radians(np.arange(360.0)), 10.0), abs=1e-6)


def test_cylinders_and_spheres_are_measured_within_a_millimetre():
    section = CrossSection(height=0.3)
    section.add(body(Cylinder(0.2, 1.0), pose3(2.0, 0.0, 0.5)))
    section.add(body(Sphere(0.5), pose3(0.0, 2.0, 0.3), name="ball::l"))
    assert ranges_at(section) == pytest.approx([1.8, 1.5, math.inf, math.inf], abs=1e-3)


def test_bodies_at_other_heights_are_not_measured():
    section = CrossSection(height=0.3)
    section.add(body(Box((1, 1, 0.2)), pose3(2.0, 0.0, 0.1)))
    section.add(body(Box((1, 1, 0.2)), pose3(2.0, 0.0, 1.0), name="lintel::l"))
    assert np.isinf(ranges_at(section)).all()


def test_a_moving_body_is_measured_at_its_present_pose():
    section = CrossSection(height=0.3)
    section.add(body(Box((1, 1, 1)), pose3(2.0, 0.0, 0.5), mass=1.0))
    assert ranges_at(section, pose_of=lambda name: pose3(2.0, 0.0, 0.5))[0] == pytest.approx(1.5)
    assert ranges_at(section, pose_of=lambda name: pose3(3.0, 0.0, 0.5))[0] == pytest.approx(2.5)


def test_kinematic_bodies_are_measured_at_their_positions_with_their_intensities():
    section, poses = CrossSection(height=0.3), {"b::l": pose3(0.0, 4.0, 0.5), "c::l": pose3(-3.0, 0.0, 0.5)}
    section.add(body(Box((1, 1, 1)), pose3(2.0, 0.0, 0.5), name="a::l", laser_retro=1.0))
    section.add(body(Box((1, 1, 1)), pose3(9.0, 9.0, 0.5), name="b::l", laser_retro=2.0, is_kinematic=True))
    section.add(body(Box((1, 1, 1)), pose3(9.0, 0.0, 0.5), name="c::l", laser_retro=3.0, is_kinematic=True))
    section.add(body(Box((1, 1, 1)), pose3(0.0, -5.0, 0.5), name="d::l", laser_retro=4.0, mass=1.0))
    poses["d::l"] = pose3(0.0, -5.0, 0.5)
    ranges, nearest = cast_beams(section.segments(poses.get), 0.0, 0.0, 0.0, math.pi / 2.0, 4, 10.0)
    assert ranges == pytest.approx([1.5, 3.5, 2.5, 4.5])
    assert section.retros()[nearest].tolist() == [1.0, 2.0, 3.0, 4.0]
    section.remove("b::l")
    assert np.isinf(ranges_at(section, pose_of=poses.get)).tolist() == [False, True, False, False]


def test_the_bearing_of_the_first_beam_may_be_any_number_of_turns():
    ranges, *turned = (
        cast_beams(SQUARE, 0.25, 0.0, 0.3 + turns * math.tau, 0.1, 50, 10.0)[0] for turns in (0, -3, 2)
    )
    for each in turned:
        assert each == pytest.approx(ranges)
