"""Semantic maps and files of objects: what they mean, and what is refused."""

import math

import pytest

from planar import Pose2, SettingsError
from planar.maps.semantic_map import FurnitureTop, load_objects, load_semantic_map

GOOD = """\
rooms:
  kitchen: {kind: kitchen}
  den: {kind: office}
furniture:
  counter: {kind: kitchen, room: kitchen, x: 1.0, y: 2.0, size: [2.0, 0.6], height: 0.9}
  desk: {kind: table, room: den, x: 5.0, y: 2.0, yaw: 1.5708, size: [1.4, 0.7], height: 0.75}
  cupboard: {kind: shelf, x: 8.0, y: 2.0, size: [1.0, 0.4], height: 1.8}
objects:
  cup: {on: {kitchen: 3, table: 1}, in: {office: 2}}
  anchor: {on: {harbour: 1}}
"""


def load(tmp_path, text):
    path = tmp_path / "semantic_map.yaml"
    path.write_text(text, encoding="utf-8")
    return load_semantic_map(path)


def test_probabilities_follow_furniture_and_rooms_and_leave_room_for_surprises(tmp_path):
    probabilities = load(tmp_path, GOOD).probabilities("cup")
    assert math.isclose(sum(probabilities.values()), 1.0)
    assert math.isclose(probabilities["counter"], 0.9 * 3 / 5 + 0.1 / 3)
    assert math.isclose(probabilities["desk"], 0.9 * 2 / 5 + 0.1 / 3)
    assert math.isclose(probabilities["cupboard"], 0.1 / 3)


def test_without_the_usual_furniture_all_is_equally_likely(tmp_path):
    assert set(load(tmp_path, GOOD).probabilities("anchor").values()) == {1 / 3}


def test_points_of_a_top_lie_on_it_and_their_furniture_is_known(tmp_path):
    semantic_map = load(tmp_path, GOOD)
    for top in semantic_map.furniture.values():
        for x, y in top.points_xy():
            assert top.distance_to(x, y) == 0.0
            assert semantic_map.furniture_at(x, y) == top.name
    assert semantic_map.furniture_at(20.0, 20.0) == ""


def test_distance_to_a_turned_top():
    top = FurnitureTop("desk", "table", "", Pose2(0.0, 0.0, math.pi / 2), (2.0, 1.0), 0.7)
    assert math.isclose(top.distance_to(0.0, 1.5), 0.5)
    assert math.isclose(top.distance_to(1.5, 0.0), 1.0)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("room: den", "room: dan", '6: furniture.desk.room names no room: dan (did you mean "den"?)'),
        ("size: [1.4, 0.7]", "size: [0, 1]", "furniture.desk.size must be from 0 to 100 m"),
        ("height: 0.75", "height: high", "furniture.desk.height must be a number"),
        ("kitchen: 3", "kitchen: -3", "objects.cup.on.kitchen must be a weight"),
        ("kind: office", "sort: office", 'unknown key "rooms.den.sort"'),
    ],
)
def test_mistakes_are_reported_with_line_and_key(tmp_path, old, new, message):
    with pytest.raises(SettingsError) as error:
        load(tmp_path, GOOD.replace(old, new))
    assert message in str(error.value)


def test_all_mistakes_are_reported_at_once(tmp_path):
    text = GOOD.replace("room: den", "room: dan").replace("kitchen: 3", "kitchen: x")
    with pytest.raises(SettingsError) as error:
        load(tmp_path, text)
    assert len(str(error.value).splitlines()) == 2


def test_what_cannot_be_searched_is_stated_in_a_sentence(tmp_path):
    assert load(tmp_path, GOOD).problem_with("cup") == ""
    assert 'objects do not list cupp (did you mean "cup"?)' in load(tmp_path, GOOD).problem_with("cupp")
    assert "has no furniture" in load(tmp_path, "objects: {cup: {on: {table: 1}}}").problem_with("cup")


def test_objects_stand_on_furniture_in_shelves_or_anywhere(tmp_path):
    load(tmp_path, GOOD)
    path = tmp_path / "objects.yaml"
    path.write_text("cup: {on: counter}\nbook: {on: cupboard}\nkey: {x: 1, y: 2, z: 0.1}\n", encoding="utf-8")
    cup, book, key = load_objects(path)
    assert (cup.x, cup.y, cup.z) == (1.0, 2.0, 0.9)
    assert book.z == 1.0
    assert (key.x, key.y, key.z) == (1.0, 2.0, 0.1)
    path.write_text("cup: {on: table}\n", encoding="utf-8")
    with pytest.raises(SettingsError, match=r"1: cup.on names no furniture of semantic_map.yaml: table"):
        load_objects(path)
