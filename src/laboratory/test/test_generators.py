import numpy as np
import pytest
from scipy.ndimage import label

from laboratory.generators.homes import APART, ROOM_TO_PASS, ROOM_TO_STAND, Homes
from laboratory.generators.raster import Raster
from laboratory.generators.rooms import SMALLEST_SIDE, Room, floor_plan
from laboratory.scenario import read_scenario
from laboratory.suites import FOLDER
from planar import FREE, SettingsError
from planar.geometry.distance_field import distance_field

SEEDS = range(6)


@pytest.fixture(scope="module")
def homes():
    return [Homes(30.0, 80.0).arena(seed) for seed in SEEDS]


@pytest.mark.parametrize("seed", [8, 41])
def test_no_furniture_stands_where_the_robot_starts(seed):
    """Homes whose map had the robot shut in by what the coarser raster took for far enough."""
    arena = Homes().arena(seed)
    distances = distance_field(arena.grid.cells != FREE, arena.grid.resolution)
    ((row, col),) = arena.grid.cells_of([[0.0, 0.0]])
    assert distances[row, col] > ROOM_TO_STAND
    assert len(arena.places) >= 2


def test_the_same_seed_makes_the_same_home_and_another_another(homes):
    for seed, home in zip(SEEDS, homes):
        again = Homes(30.0, 80.0).arena(seed)
        np.testing.assert_array_equal(home.grid.cells, again.grid.cells)
    assert len({home.title for home in homes}) > 1


def test_every_place_can_be_reached_from_where_the_robot_starts(homes):
    for home in homes:
        regions, _ = label(distance_field(home.grid.cells != FREE, home.grid.resolution) > ROOM_TO_PASS)
        places = [(0.0, 0.0)] + [(place.pose.x, place.pose.y) for place in home.places]
        of_places = {int(regions[tuple(cell)]) for cell in home.grid.cells_of(places)}
        assert len(of_places) == 1 and of_places != {0}


def test_places_are_apart_and_enough_for_chores(homes):
    for home in homes:
        assert len(home.places) >= 2
        for number, place in enumerate(home.places):
            assert all(place.pose.distance_to(other.pose) > APART for other in home.places[:number])


@pytest.mark.parametrize("seed", range(20))
def test_rooms_fill_the_outline_and_every_one_is_connected_by_doors(seed):
    outline = Room(0.0, 0.0, 16.0, 12.0)
    rooms, walls = floor_plan(outline, np.random.default_rng(seed))
    assert len(rooms) > 1
    assert sum(room.area for room in rooms) == pytest.approx(outline.area)
    assert min(min(room.width, room.depth) for room in rooms) >= SMALLEST_SIDE - 1e-9
    raster = Raster(outline.width, outline.depth)
    for wall in walls:
        raster.fill(*wall.solid.corners)
    reach = raster.reach(*rooms[0].middle, ROOM_TO_PASS)
    assert reach > 0.0
    assert all(raster.reach(*room.middle, ROOM_TO_PASS) == pytest.approx(reach) for room in rooms)


def test_an_area_that_no_home_has_is_refused(tmp_path):
    path = tmp_path / "homes.yaml"
    text = (FOLDER / "homes.yaml").read_text()
    path.write_text(text.replace("[30, 300]", "[10, 20]"))
    with pytest.raises(SettingsError, match=r"homes.yaml:2: world.homes.area must be within 30 to 300 m2"):
        read_scenario(path)
