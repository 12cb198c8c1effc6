"""True maps are exact."""

import math
from pathlib import Path

import numpy as np
import pytest

from planar import FREE, OCCUPIED, UNKNOWN, load_map
from planar.maps.map_score import score_map
from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.geometry.shapes import Box, Cylinder, Mesh, Plane, Sphere
from sim_bridge.sdf import load_world
from sim_bridge.views.true_map import true_map
from sim_bridge.world import Body, Collision, World

HOME_MAP = Path(__file__).resolve().parents[3] / "map"


def world_of(*shapes_and_poses):
    parts = tuple(Collision(shape, pose) for shape, pose in shapes_and_poses)
    return World("w", (Body("m::l", np.eye(4), parts),))


def area(grid, value=OCCUPIED):
    return (grid.cells == value).sum() * grid.resolution**2


def test_a_box_on_cell_borders_fills_exactly_its_cells():
    grid = true_map(world_of((Box((1.0, 0.5, 1.0)), pose3(2.0, 0.25, 0.5))))
    assert area(grid) == pytest.approx(0.5)
    assert grid.value_at(1.51, 0.01) == OCCUPIED
    assert grid.value_at(1.49, 0.01) == FREE


@pytest.mark.parametrize(
    ("shape", "pose", "expected"),
    [
        (Box((1.0, 0.5, 1.0)), pose3(2.0, 0.0, 0.0, yaw=0.7), 0.5),
        (Cylinder(0.5, 1.0), pose3(2.0, 0.0, 0.5), math.pi * 0.25),
        (Sphere(0.5), pose3(2.0, 0.0, 0.3), math.pi * 0.25),
        (Sphere(0.5), pose3(2.0, 0.0, 0.0), math.pi * (0.25 - 0.3**2)),
        (Cylinder(0.5, 1.0), pose3(2.0, 0.0, 0.3, pitch=math.pi / 2.0), 1.0),
        (Box((1.0, 1.0, 1.0)), pose3(2.0, 0.0, 0.3, pitch=math.pi / 4.0), math.sqrt(2.0)),
    ],
)
def test_areas_are_those_of_the_slice(shape, pose, expected):
    """The cells on the rim are occupied too: half a cell more, all along the rim of at most 5 m."""
    grid = true_map(world_of((shape, pose)), resolution=0.01, thickness=1e-6)
    assert expected - 1e-3 <= area(grid) <= expected + 5.0 * 0.01


def test_solids_above_or_below_the_slice_are_not_in_the_map():
    with pytest.raises(WorldError, match="nothing is solid at a height of 0.3 m"):
        true_map(
            world_of(
                (Box((1, 1, 0.2)), pose3(2, 0, 0.1)), (Box((1, 1, 0.2)), pose3(2, 0, 2.0)), (Plane(), pose3())
            )
        )


def test_space_outside_closed_walls_is_unknown():
    walls = [(Box((2.0, 0.1, 1.0)), pose3(0.0, y, 0.5)) for y in (-1.0, 1.0)]
    walls += [(Box((0.1, 2.0, 1.0)), pose3(x, 0.0, 0.5)) for x in (-1.0, 1.0)]
    grid = true_map(world_of(*walls))
    assert grid.value_at(0.9, 0.0) == FREE
    assert grid.value_at(1.2, 0.0) == UNKNOWN


def test_a_mesh_is_sliced_into_its_outline():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    triangles = np.array([[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])
    grid = true_map(world_of((Mesh(corners, triangles), pose3(2.0))), resolution=0.01)
    assert grid.value_at(2.35, 0.35) == OCCUPIED, "the slope is 0.7 - x - y away at this height"
    assert grid.value_at(2.4, 0.4) == FREE
    assert grid.value_at(2.2, 0.2) == UNKNOWN, "the inside cannot be reached"


def test_a_start_inside_a_solid_is_an_error():
    with pytest.raises(WorldError, match=r"\(2, 0\) is not free space"):
        true_map(world_of((Box((1, 1, 1)), pose3(2.0, 0.0, 0.5))), inside=(2.0, 0.0))


def test_the_shipped_map_of_the_home_is_good_enough_to_have_been_made_by_map_home():
    world = load_world(HOME_MAP / "home.world")
    score = score_map(load_map(HOME_MAP / "home.yaml"), true_map(world))
    assert score.recall >= 0.95
    assert score.precision >= 0.95
    assert score.doubled_walls == 0
