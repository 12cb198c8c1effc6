import time

import pytest

from pick_objects import Delivery, ErrandSettings, load_mission, parse_mission
from pick_objects.mission_file import _check_cycles
from planar import Pose2, SettingsError, grid_from_picture
from planar.maps.places import NamedPlace

GOOD = """\
name: evening
places:
  kitchen: {x: 0.5, y: 0.5, radius: 0.3}
  desk:
    x: 1.5
    y: 0.5
    approaches:
      - {x: 2.5, y: 0.5, yaw: 1.57}
objects:
  cup: {size: 0.1, color: [0, 0, 1]}
  letter: {}
settings: {goal_timeout: 60, on_failure: continue}
deliveries:
  - {name: tea, object: cup, from: kitchen, to: desk}
  - {name: post, object: letter, from: desk, to: door, after: tea, goal_timeout: 30}
  - {name: back, object: cup, from: desk, to: kitchen}
"""
DOOR = NamedPlace("door", Pose2(0.0, 2.0))


def parse(text=GOOD, **known):
    return parse_mission(text, {"door": DOOR}, **known)


def test_a_mission_may_refer_to_known_places(tmp_path):
    mission = parse(defaults=ErrandSettings(attempts=7))
    assert mission.name == "evening"
    assert mission.places["desk"].approaches == (Pose2(2.5, 0.5, 1.57),)
    assert mission.places["door"] is DOOR
    assert mission.object_named("cup").color == (0.0, 0.0, 1.0)
    assert mission.deliveries[1] == Delivery("post", "letter", "desk", "door", ("tea",), 30.0)
    settings = mission.settings
    assert (settings.goal_timeout, settings.on_failure, settings.attempts) == (60.0, "continue", 7)
    path = tmp_path / "evening.yaml"
    path.write_text(GOOD)
    assert load_mission(path, {"door": DOOR}).deliveries == mission.deliveries


@pytest.mark.parametrize(
    "before, after, complaint",
    [
        ("from: kitchen", "from: kitchn", r"mission:14: deliveries\[1\].from names no place: kitchn"),
        ("to: door", "to: moon", r"mission:15: deliveries\[2\].to names no place: moon .known: "),
        ("object: letter", "object: later", r"mission:15: deliveries\[2\].object names no object: later"),
        ("after: tea", "after: milk", r"mission:15: deliveries\[2\].after names no delivery: milk"),
        ("name: post", "name: tea", r"mission:15: deliveries\[2\].name tea is that of another"),
        ("  letter: {}", "  letter: {}\n  cup: {}", 'mission:12: duplicate key "cup", first in line 10'),
        (
            "goal_timeout: 60",
            "goal_timeout: -60",
            "mission:12: settings.goal_timeout must be positive",
        ),
        (
            "goal_timeout: 30",
            "goal_timeout: -3",
            r"mission:15: deliveries\[2\].goal_timeout must be positive",
        ),
        ("goal_timeout: 60", "goal_time: 60", 'mission:12: unknown key "settings.goal_time"'),
        ("continue", "go on", "mission:12: settings.on_failure must be one of stop, continue, got 'go on'"),
        ("radius: 0.3", "radius: 0", "mission:3: places.kitchen.radius must be positive"),
        ("size: 0.1", "size: huge", "mission:10: objects.cup.size must be a number"),
        ("[0, 0, 1]", "[0, 0, 9]", "mission:10: objects.cup.color must be three numbers from 0 to 1"),
        ("letter: {}", "letter: {solid: maybe}", "mission:11: objects.letter.solid must be true or false"),
        (
            "size: 0.1",
            "size: 0.3, solid: true",
            "mission:10: objects.cup.size must be at most 0.25",
        ),
        ("to: desk}", "to: kitchen}", r"mission:14: deliveries\[1\].to must be another place than kitchen"),
        (
            "from: desk, to: kitchen",
            "from: door, to: kitchen",
            r"mission:16: .*from must be desk, where tea leaves cup",
        ),
        ("to: desk}", "to: desk, after: post}", r"mission:14: deliveries\[1\].after makes a cycle"),
        ("to: desk}", "to: desk, after: [back]}", r"mission:14: deliveries\[1\].after makes a cycle"),
        ("to: desk}", "to: desk, after: [tea]}", r"mission:14: deliveries\[1\].after makes a cycle"),
        ("deliveries:", "delivery:", 'mission:13: unknown key "delivery" .did you mean "deliveries"'),
        (GOOD[GOOD.index("deliveries") :], "", "mission:1: deliveries are missing"),
        ("object: cup, ", "", r"mission:14: deliveries\[1\].object is missing"),
    ],
)
def test_a_mistake_is_reported_with_line_and_key(before, after, complaint):
    assert before in GOOD
    with pytest.raises(SettingsError, match=complaint):
        parse(GOOD.replace(before, after, 1))


@pytest.mark.parametrize(
    "picture, complaint",
    [
        ("#..", r"mission:3: places.kitchen.x and y: \(0.5, 0.5\) lies in an obstacle of the map"),
        (".?.", "mission:5: places.desk.x and y: .* lies in unknown space of the map"),
        ("..#", r"mission:8: places.desk.approaches\[1\].x and y: .* lies in an obstacle"),
        ("..", r"mission:8: places.desk.approaches\[1\].x and y: .* lies outside the map"),
    ],
)
def test_a_place_in_a_wall_is_reported_with_line_and_key(picture, complaint):
    with pytest.raises(SettingsError, match=complaint):
        parse(grid=grid_from_picture(picture))
    assert parse(grid=grid_from_picture("...")).places


def test_all_mistakes_of_a_mission_are_reported_at_once():
    text = """\
plaecs: {}
places: {desk: {x: 1}, door: {x: a, y: 2}, shelf: {x: 1, y: 2}}
objects: {cup: {size: -1}, plate: {size: 0.1}, book: {color: [1, 2]}}
settings: {pickup_seconds: soon}
deliveries:
  - {object: plate, from: shelf, to: shelf}
  - {object: plate, from: cellar, to: attic}
  - {object: plate, from: kitchen}
"""
    with pytest.raises(SettingsError) as caught:
        parse_mission(text, {"kitchen": NamedPlace("kitchen", Pose2())})
    lines = [line.split(":")[1] for line in str(caught.value).splitlines()]
    assert lines == ["1", "2", "2", "3", "3", "4", "6", "7", "7", "8"]


def chain(count):
    """Deliveries each of which waits for the next one in the file."""
    entry = "  - {{name: d{0}, object: o{0}, from: door, to: desk, after: {1}}}"
    entries = [entry.format(i, f"d{i + 1}" if i + 1 < count else "[]") for i in range(count)]
    return "places:\n  desk: {x: 1.0, y: 1.0}\ndeliveries:\n" + "\n".join(entries)


def test_a_long_chain_of_deliveries_is_checked_in_linear_time():
    deliveries = list(parse(chain(2000)).deliveries)
    start = time.process_time()
    _check_cycles(deliveries, {})
    assert time.process_time() - start < 1.0
