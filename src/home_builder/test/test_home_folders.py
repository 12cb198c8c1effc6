"""Folders of homes: what is built, and how its parts are tied."""

import math
from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from home_builder import FurniturePiece, HomePlan, Opening, Place, Room, Wall, Zone, build_home
from home_builder.errors import InvalidPlanError
from home_builder.palette import KINDS
from home_builder.semantics import semantic_map_of
from pick_objects import load_mission
from planar import FREE, OCCUPIED, SettingsError, load_map
from planar.maps.home_folder import load_home
from planar.maps.places import load_pickup_and_dropoff, load_places, unreachable_reason
from planar.maps.semantic_map import load_objects, load_semantic_map
from sim_bridge import load_world

WALLS = (
    Wall((0.0, 0.0), (8.0, 0.0)),
    Wall((8.0, 0.0), (8.0, 6.0)),
    Wall((8.0, 6.0), (0.0, 6.0)),
    Wall((0.0, 6.0), (0.0, 0.0)),
    Wall((4.0, 0.0), (4.0, 6.0), openings=(Opening("door", 2.0),)),
)
BED = FurniturePiece("bed", 1.2, 5.0, 0.0, (2.0, 1.6, 0.9))
PLAN = HomePlan(
    "house",
    WALLS,
    (BED,),
    (Room("kitchen", 1.0, 1.0), Room("bedroom", 6.0, 1.0)),
    (Place("window", 7.0, 5.0, 1.5),),
    (Zone("stairs", "keep_out", ((6.0, 4.0), (7.0, 4.0), (7.0, 5.0))),),
    (2.0, 2.0),
)


@pytest.fixture(name="home")
def home_(tmp_path) -> Path:
    assert build_home(PLAN, tmp_path / "home") == []
    return tmp_path / "home"


def test_world_map_zones_and_mission_agree(home):
    parts = load_home(home)
    world, grid = load_world(parts.world), load_map(parts.map)
    assert world.warnings == ()
    assert grid.value_at(0.0, 0.0) == FREE
    assert grid.value_at(-2.0, -2.0) == OCCUPIED  # a corner, in the frame of the start
    assert grid.value_at(2.0, 0.0) == FREE  # the door
    places = load_places(parts.zones)
    assert {"kitchen", "bedroom", "bed", "window", "pickup", "dropoff"} <= set(places)
    assert all(unreachable_reason(place, grid) is None for place in places.values())
    assert load_pickup_and_dropoff(parts.zones)
    mission = load_mission(parts.mission, places, grid=grid)
    assert [{each.source, each.destination} for each in mission.deliveries] == [{"bedroom", "kitchen"}]
    assert yaml.safe_load(parts.navigation_zones.read_text())["stairs"]["corners"][0] == [4.0, 2.0]


def test_the_robot_stops_in_front_of_furniture_and_faces_it(home):
    bed = load_places(load_home(home).zones)["bed"].pose
    towards = math.atan2(BED.y - 2.0 - bed.y, BED.x - 2.0 - bed.x)
    assert abs(bed.yaw - towards) < 0.01
    assert 0.8 < math.hypot(bed.x + 2.0 - BED.x, bed.y + 2.0 - BED.y) < 2.0


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_furniture_is_seen_by_a_laser(kind, tmp_path):
    piece = FurniturePiece(kind, 6.0, 3.0, 0.0, KINDS[kind].size)
    build_home(HomePlan(walls=WALLS, furniture=(piece,), start=(2.0, 2.0)), tmp_path / "home")
    grid = load_map(tmp_path / "home/home.yaml")
    width, depth, _ = piece.size
    corner = (4.0 - width / 2.0 + 0.02, 1.0 - depth / 2.0 + 0.02)
    edge = (4.0 - width / 2.0 + 0.02, 1.0)
    assert OCCUPIED in (grid.value_at(*corner), grid.value_at(*edge))


def test_the_inside_of_an_outline_is_solid(tmp_path):
    corners = ((-1.0, -1.0), (1.0, -1.0), (1.0, 0.0), (0.0, 0.0), (0.0, 1.0), (-1.0, 1.0))
    piece = FurniturePiece("outline", 6.0, 3.0, 0.3, (2.0, 2.0, 0.8), "", corners)
    build_home(HomePlan(walls=WALLS, furniture=(piece,), start=(2.0, 2.0)), tmp_path / "home")
    grid = load_map(tmp_path / "home/home.yaml")
    cos, sin = math.cos(0.3), math.sin(0.3)

    def at(x, y):
        return grid.value_at(4.0 + x * cos - y * sin, 1.0 + x * sin + y * cos)

    assert {at(-0.5, -0.5), at(0.5, -0.5), at(-0.5, 0.5)} == {OCCUPIED}
    assert at(0.5, 0.5) == FREE


@pytest.mark.parametrize(
    ("part", "complaint"),
    [
        ("plan.yaml", "was changed after home.world, home.pgm and zones.yaml were made from it"),
        ("home.world", "was changed after home.pgm was rendered from it"),
        ("home.pgm", "does not belong to this home: it is not the one that was made from home.world"),
        ("home.yaml", "does not belong to this home"),
    ],
)
def test_a_part_that_was_changed_is_named(home, part, complaint):
    with (home / part).open("ab") as file:
        file.write(b"\n")
    with pytest.raises(SettingsError, match=f"{part}: {complaint}.*build_home.sh"):
        load_home(home)


def test_a_missing_part_and_a_folder_that_is_no_home_are_named(home, tmp_path):
    (home / "home.pgm").unlink()
    with pytest.raises(SettingsError, match="home.pgm: is missing"):
        load_home(home)
    with pytest.raises(SettingsError, match="has no manifest.yaml"):
        load_home(tmp_path)


def test_building_again_keeps_an_edited_mission(home):
    mission = home / "mission.yaml"
    mission.write_text(mission.read_text() + "# mine\n")
    load_home(home)
    remarks = build_home(PLAN, home)
    assert remarks == [f"{mission}: kept, as it was edited"]
    assert mission.read_text().endswith("# mine\n")
    load_home(home)


def test_a_plan_with_errors_writes_nothing(tmp_path):
    plan = HomePlan(
        walls=(Wall((0.0, 0.0), (1.0, 0.0), openings=(Opening("door", 0.5, 2.0),)),), start=(5.0, 5.0)
    )
    with pytest.raises(InvalidPlanError, match=r"wider than the wall: 2.00 of 1.00 m at \(0.50, 0.00\)"):
        build_home(plan, tmp_path / "home")
    assert not (tmp_path / "home").exists()


def test_the_same_plan_gives_the_same_files(home, tmp_path):
    build_home(PLAN, tmp_path / "again")
    for path in home.iterdir():
        assert path.read_bytes() == (tmp_path / "again" / path.name).read_bytes()


def test_the_robot_starts_at_the_origin_with_the_heading_of_the_plan(home, tmp_path):
    build_home(replace(PLAN, start_yaw=math.pi / 2.0), tmp_path / "turned")
    straight, turned = (load_home(folder) for folder in (home, tmp_path / "turned"))
    for x, y in ((2.0, 0.0), (-2.0, -2.0), (0.0, 0.0)):  # the door, a corner, the start
        assert load_map(turned.map).value_at(y, -x) == load_map(straight.map).value_at(x, y)
    before, after = (load_places(each.zones)["bed"].pose for each in (straight, turned))
    assert (after.x, after.y) == pytest.approx((before.y, -before.x), abs=0.15)
    assert math.sin(after.yaw - before.yaw + math.pi / 2.0) == pytest.approx(0.0, abs=0.1)
    corners = yaml.safe_load(turned.navigation_zones.read_text())["stairs"]["corners"]
    assert corners[0] == pytest.approx([2.0, -4.0])


def test_the_semantic_map_names_rooms_and_furniture_where_they_are(home):
    semantic_map = load_semantic_map(load_home(home).semantic_map)
    assert semantic_map.rooms == {"kitchen": "kitchen", "bedroom": "bedroom"}
    (bed,) = semantic_map.furniture.values()
    assert (bed.name, bed.kind, bed.room) == ("bed in kitchen", "bed", "kitchen")
    assert (bed.pose.x, bed.pose.y) == (-0.8, 3.0)  # in the frame of the start
    assert math.isclose(bed.height, 0.55 * 0.9)
    assert math.isclose(semantic_map.probabilities("book")["bed in kitchen"], 1.0)


def test_edited_semantic_maps_and_objects_are_kept(home):
    for name in ("semantic_map.yaml", "objects.yaml"):
        edited = (home / name).read_text(encoding="utf-8").replace("book:", "atlas:")
        (home / name).write_text(edited, encoding="utf-8")
        remarks = build_home(PLAN, home)
        assert f"{home / name}: kept, as it was edited" in remarks
        assert "atlas:" in (home / name).read_text(encoding="utf-8")


def test_objects_are_on_furniture_that_can_hold_them(home):
    parts = load_home(home)
    objects = {item.name: item for item in load_objects(parts.objects)}
    assert objects.keys() == load_semantic_map(parts.semantic_map).objects.keys()
    assert math.isclose(objects["cup"].z, 0.55 * 0.9)


def test_a_home_without_furniture_has_a_semantic_map_without_any(tmp_path):
    build_home(replace(PLAN, furniture=()), tmp_path / "bare")
    parts = load_home(tmp_path / "bare")
    assert "has no furniture" in load_semantic_map(parts.semantic_map).problem_with("cup")
    assert load_objects(parts.objects) == ()


def test_equal_pieces_of_a_room_are_numbered():
    tables = [FurniturePiece("table", 1.0 + number, 2.0, 0.0, (0.5, 0.5, 0.7)) for number in range(2)]
    outline = FurniturePiece(
        "outline", 6.0, 3.0, 0.0, (1.0, 1.0, 0.8), "", ((-1.0, -0.5), (1.0, -0.5), (1.0, 0.5), (-1.0, 0.5))
    )
    named = FurniturePiece("shelf", 7.0, 1.0, 0.0, (1.0, 0.3, 1.8), "archive")
    furniture = semantic_map_of(replace(PLAN, furniture=(*tables, outline, named))).furniture
    assert list(furniture) == [
        *("table in kitchen", "table 2 in kitchen", "furniture in bedroom", "archive"),
    ]
    assert sorted(round(side, 6) for side in furniture["furniture in bedroom"].size) == [1.0, 2.0]


def test_the_semantic_map_of_a_turned_start_is_turned(home):
    straight, turned = (
        semantic_map_of(replace(PLAN, start_yaw=yaw)).furniture["bed in kitchen"].pose
        for yaw in (0.0, math.pi / 2.0)
    )
    assert (turned.x, turned.y) == pytest.approx((straight.y, -straight.x))
    assert math.sin(turned.yaw - straight.yaw) == pytest.approx(-1.0)
