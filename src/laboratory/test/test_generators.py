import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import label

from laboratory.generators.buildings import PLACE_SPACING, _arena
from laboratory.generators.floor_plan import SMALLEST_SIDE, Rectangle, generate_floor_plan
from laboratory.generators.furniture import PASSAGE_RADIUS, STANDING_CLEARANCE
from laboratory.generators.halls import Halls
from laboratory.generators.homes import Homes
from laboratory.generators.offices import Offices
from laboratory.generators.raster import Raster
from laboratory.runner import run_scenario
from laboratory.scenario import read_scenario
from laboratory.suites import FOLDER
from laboratory.tasks.shortest_paths import PASSAGE_CLEARANCE
from planar import FREE, SettingsError
from planar.geometry.distance_field import distance_field

SEEDS = range(6)
SMALL = {"homes": Homes(30.0, 80.0), "offices": Offices(60.0, 160.0), "halls": Halls(80.0, 200.0)}


@pytest.fixture(scope="module", params=SMALL)
def buildings(request):
    """A world source and some of its arenas."""
    source = SMALL[request.param]
    return source, [source.arena(seed) for seed in SEEDS]


def clearance_of(arena):
    return distance_field(arena.grid.cells != FREE, arena.grid.resolution)


def reachable_share(arena):
    """Share of the traversable space that is reachable from the start."""
    regions, _ = label(clearance_of(arena) > PASSAGE_CLEARANCE)
    return (regions == regions[cell_at(arena, 0.0, 0.0)]).sum() / (regions > 0).sum()


def cell_at(arena, x, y):
    ((row, col),) = arena.grid.cells_of([[x, y]])
    return row, col


@pytest.mark.parametrize("seed", [8, 41])
def test_the_start_is_free_of_furniture(seed):
    """Regression: in these homes the robot was enclosed, because the raster overestimates distances."""
    arena = Homes().arena(seed)
    assert clearance_of(arena)[cell_at(arena, 0.0, 0.0)] > STANDING_CLEARANCE
    assert len(arena.places) >= 2


def test_a_building_depends_on_the_seed_only(buildings):
    source, arenas = buildings
    for seed, arena in zip(SEEDS, arenas):
        again = _arena.__wrapped__(source, seed)
        np.testing.assert_array_equal(arena.grid.cells, again.grid.cells)
        assert arena.places == again.places
    assert len({arena.title for arena in arenas}) > 1


def test_a_building_has_the_requested_area(buildings):
    source, arenas = buildings
    for arena in arenas:
        xy = np.array([body.pose_in_world[:2, 3] for body in arena.world.bodies if "wall_" in body.name])
        width, depth = np.ptp(xy, axis=0)
        assert source.min_area <= width * depth <= source.max_area
        assert f"{source.kind} of {width * depth:.0f} m2" == arena.title


def test_every_place_is_reachable_from_the_start(buildings):
    for arena in buildings[1]:
        regions, _ = label(clearance_of(arena) > PASSAGE_CLEARANCE)
        places = [(0.0, 0.0)] + [(place.pose.x, place.pose.y) for place in arena.places]
        of_places = {int(regions[cell_at(arena, *place)]) for place in places}
        assert len(of_places) == 1 and of_places != {0}


@pytest.mark.parametrize("seed", [31, 36, 40])
def test_furniture_does_not_cut_off_rooms(seed):
    """Regression: in these homes furniture cut off half of the space or more."""
    assert reachable_share(Homes().arena(seed)) > 0.98


def test_nearly_all_of_a_building_is_reachable(buildings):
    for arena in buildings[1]:
        assert reachable_share(arena) > 0.98, arena.world.name


def test_a_building_has_at_least_two_separate_places(buildings):
    for arena in buildings[1]:
        assert len(arena.places) >= 2
        for number, place in enumerate(arena.places):
            assert all(place.pose.distance_to(other.pose) > PLACE_SPACING for other in arena.places[:number])


def test_an_office_has_a_door_from_its_corridor_to_each_room_and_some_between_rooms():
    layouts = [Offices().layout(200.0, np.random.default_rng(seed)) for seed in range(12)]
    for layout in layouts:
        _, y = layout.start
        beside_corridor = [door for door in layout.doorways if door.y1 == door.y2 and abs(door.y1 - y) < 1.3]
        assert len(beside_corridor) >= 6
        assert {door.y1 < y for door in beside_corridor} == {True, False}
    between_rooms = [sum(door.x1 == door.x2 for door in layout.doorways) for layout in layouts]
    assert sum(between_rooms) > 12


def test_halls_have_shelves_or_pillars_with_aisles_between_them():
    kinds = set()
    for seed in range(12):
        layout = Halls().layout(300.0, np.random.default_rng(seed))
        first = layout.furniture[0]
        standing = [piece for piece in layout.furniture if piece.area == pytest.approx(first.area)]
        kinds.add(math.isclose(first.width, first.depth))
        assert len(standing) >= 4
        for number, piece in enumerate(standing):
            for other in standing[:number]:
                gap_x = abs(piece.x - other.x) - piece.width
                gap_y = abs(piece.y - other.y) - piece.depth
                assert max(gap_x, gap_y) > 1.3
    assert kinds == {True, False}


@pytest.mark.parametrize("suite", ["offices", "halls"])
def test_deliveries_succeed_in_a_generated_building(suite):
    scenario = replace(read_scenario(FOLDER / f"{suite}.yaml"), world=SMALL[suite])
    result = run_scenario(scenario, 1)
    assert result.is_success, result.reason


@pytest.mark.parametrize("seed", range(20))
def test_rooms_fill_the_outline_and_are_connected_by_doors(seed):
    outline = Rectangle(0.0, 0.0, 16.0, 12.0)
    rooms, walls, doorways = generate_floor_plan(outline, np.random.default_rng(seed))
    assert len(doorways) == len(rooms) - 1
    assert len(rooms) > 1
    assert sum(room.area for room in rooms) == pytest.approx(outline.area)
    assert min(min(room.width, room.depth) for room in rooms) >= SMALLEST_SIDE - 1e-9
    raster = Raster(outline.width, outline.depth)
    for wall in walls:
        raster.fill(*wall.solid.corners)
    reach = raster.reachable_from(*rooms[0].middle, PASSAGE_RADIUS)
    assert reach.any()
    assert all((raster.reachable_from(*room.middle, PASSAGE_RADIUS) == reach).all() for room in rooms)


@pytest.mark.parametrize(
    ("kind", "areas"), [("homes", "30, 300"), ("offices", "60, 400"), ("halls", "80, 800")]
)
def test_an_unsupported_area_is_refused(kind, areas, tmp_path):
    path = tmp_path / "scenario.yaml"
    text = (FOLDER / f"{kind}.yaml").read_text()
    path.write_text(text.replace(f"[{areas}]", "[10, 20]"))
    within = areas.replace(",", " to")
    with pytest.raises(
        SettingsError, match=rf"scenario.yaml:2: world.{kind}.area must be within {within} m2"
    ):
        read_scenario(path)
