"""Values beyond the limits are refused."""

import math

import numpy as np
import pytest

from planar import OccupancyGrid, PlanarError, Pose2, Scan, grid_from_picture
from planar.geometry.ray_casting import cast_rays

INVALID = (math.nan, math.inf, -math.inf, 1e300)


def scan(**changed):
    numbers = {"stamp": 1.0, "angle_min": -1.0, "angle_increment": 0.5, "range_min": 0.1, "range_max": 5.0}
    return Scan(ranges=np.ones(5, np.float32), **{**numbers, **changed})


@pytest.mark.parametrize("value", INVALID)
@pytest.mark.parametrize("name", ["angle_min", "angle_increment", "range_min", "range_max"])
def test_a_scan_with_invalid_numbers_is_refused(name, value):
    with pytest.raises(PlanarError, match=f"a scan with invalid {name}"):
        scan(**{name: value})


@pytest.mark.parametrize("place", [Pose2(math.nan, 0.0), Pose2(0.0, 1e18), Pose2(yaw=1e300)])
def test_a_scan_with_an_invalid_laser_pose_is_refused(place):
    with pytest.raises(PlanarError):
        scan(laser_in_base=place)


@pytest.mark.parametrize("resolution", [*INVALID, 0.0, -1.0, 1e-30])
def test_a_grid_with_an_invalid_resolution_is_refused(resolution):
    with pytest.raises(PlanarError):
        OccupancyGrid(np.zeros((2, 2), np.int8), resolution)


@pytest.mark.parametrize("value", INVALID)
def test_a_grid_with_an_invalid_origin_is_refused(value):
    with pytest.raises(PlanarError):
        OccupancyGrid(np.zeros((2, 2), np.int8), 0.05, Pose2(value))


def test_a_ray_from_far_outside_the_map_is_cast_quickly():
    """Cell by cell outside the map this would take more than a minute."""
    grid = grid_from_picture("....\n.#..\n....", resolution=0.01)
    away = np.zeros(2000)
    from_left = cast_rays(grid, Pose2(-1e6, 0.015), away, 1e7)
    assert from_left == pytest.approx(1e6 + 0.01, abs=0.01)
    assert (cast_rays(grid, Pose2(-1e6, 0.015, math.pi), away, 1e7) == 1e7).all()
    assert (cast_rays(grid, Pose2(-1e6, 5.0), away, 1e7) == 1e7).all()


def test_a_ray_from_beside_the_map_is_as_long_as_one_from_within_it():
    grid = grid_from_picture("......\n.....#\n......", resolution=0.5)
    angles = np.linspace(-0.1, 0.1, 5)
    start = Pose2(-3.25, 0.75)
    wide = grid_from_picture("." * 20 + "\n" + "." * 19 + "#\n" + "." * 20, 0.5, Pose2(-7.0, 0.0))
    assert cast_rays(grid, start, angles, 20.0) == pytest.approx(cast_rays(wide, start, angles, 20.0))
