"""Plans: their file, geometry and checks."""

import math

import pytest

from home_builder import (
    FurniturePiece,
    HomePlan,
    Opening,
    Place,
    Room,
    Wall,
    Zone,
    parse_plan,
    plan_text,
    problems_of,
)
from home_builder.plan.geometry import end_extensions, room_faces, solid_polygons, wall_blocks
from planar import SettingsError

OUTER = (
    Wall((0.0, 0.0), (8.0, 0.0), openings=(Opening("window", 6.0, 1.2, 0.9, 2.1),)),
    Wall((8.0, 0.0), (8.0, 6.0)),
    Wall((8.0, 6.0), (0.0, 6.0)),
    Wall((0.0, 6.0), (0.0, 0.0)),
)
INNER = Wall((4.0, 0.0), (4.0, 6.0), openings=(Opening("door", 2.0),))
HOUSE = HomePlan("house", (*OUTER, INNER), rooms=(Room("kitchen", 1.0, 1.0),), start=(2.0, 2.0))


def texts(plan: HomePlan):
    return [problem.text for problem in problems_of(plan)]


def test_a_plan_file_is_read_back_without_loss():
    plan = HomePlan(
        "Müller: 1",
        (
            Wall(
                (0.1, 1 / 3),
                (math.pi, -2e-5),
                0.2,
                2.7,
                (Opening("door", 1.0), Opening("window", 2.0, 0.4, 1, 2)),
            ),
        ),
        (
            FurniturePiece("bed", 1.0, 2.0, 0.3, (2.0, 1.5, 0.5), "my bed"),
            FurniturePiece(
                "outline", 1.0, 2.0, 0.0, (1.0, 1.0, 0.8), "", ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
            ),
        ),
        (Room("kitchen", 1.0, 1.0),),
        (Place("dock", 1.0, 2.0, 1.5, 0.3),),
        (
            Zone("glass", "keep_out", ((0, 0), (1, 0), (1, 1))),
            Zone("slow", "speed", ((0, 0), (1, 0), (1, 1)), 0.2),
        ),
        (0.5, -0.5),
    )
    assert parse_plan(plan_text(plan)) == plan


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("walls: [{start: [0, 0], end: [1]}]", r"plan:1: walls\[1\].end must be \[x, y\]"),
        ("walls: [{start: [0, 0], end: [.inf, 0]}]", "must be a number"),
        ("walls: [{start: [0, 0], end: [1e9, 0]}]", "within 1000 m"),
        ("walls: [{start: [0, 0], end: [1, 0], thickness: 0}]", "thickness must be positive"),
        ("furniture: [{kind: piano, x: 0, y: 0}]", "kind must be one of"),
        ("zones: [{name: a, kind: keep_out, corners: [[0, 0]]}]", "at least 3 points"),
        ("wall: []", 'unknown key "wall"'),
    ],
)
def test_a_mistake_in_a_plan_file_is_reported_with_line_and_key(text, complaint):
    with pytest.raises(SettingsError, match=complaint):
        parse_plan(text)


def test_closed_faces_are_rooms_with_doors_taken_as_closed():
    faces = room_faces(HOUSE)
    assert sorted(face.name for face in faces) == ["kitchen", "room 1"]
    # 4 x 6 m between centre lines, less half of the walls of 0.12 m on each side
    assert [face.polygon.area for face in faces] == pytest.approx([3.88 * 5.88] * 2, rel=1e-3)


def test_furniture_closes_a_gap_of_a_wall():
    gap = Wall((8.0, 6.0), (2.0, 6.0))
    walls = (OUTER[0], OUTER[1], gap, OUTER[3])
    assert room_faces(HomePlan(walls=walls)) == []
    shelf = FurniturePiece("shelf", 1.0, 6.0, 0.0, (1.9, 0.3, 1.8))
    assert [face.name for face in room_faces(HomePlan(walls=walls, furniture=(shelf,)))] == ["room 1"]


def test_a_wall_that_ends_on_another_one_reaches_its_far_face():
    thick = Wall((0.0, -1.0), (0.0, 1.0), 0.4)
    assert end_extensions([thick, Wall((0.0, 0.0), (3.0, 0.0))]) == [(0.0, 0.0), (0.2, 0.0)]


def test_a_door_leaves_a_lintel_and_a_window_a_parapet():
    wall = Wall(
        (0.0, 0.0), (4.0, 0.0), openings=(Opening("window", 3.0, 1.0, 0.9, 2.1), Opening("door", 1.0, 1.0))
    )
    assert wall_blocks(wall) == [
        (0.0, 0.5, 0.0, 2.5),
        (0.5, 1.5, 2.0, 2.5),
        (1.5, 2.5, 0.0, 2.5),
        (2.5, 3.5, 0.0, 0.9),
        (2.5, 3.5, 2.1, 2.5),
        (3.5, 4.0, 0.0, 2.5),
    ]
    assert sum(polygon.area for polygon in solid_polygons([wall])) == pytest.approx(3.0 * 0.12)


def test_a_good_plan_has_no_problems_but_a_room_without_a_door():
    assert texts(HOUSE) == []
    closed = HomePlan(walls=(*OUTER, Wall((4.0, 0.0), (4.0, 6.0))), start=(2.0, 2.0))
    assert texts(closed) == ["room 1 has no door", "room 2 has no door"]


@pytest.mark.parametrize(
    ("change", "complaint", "is_error"),
    [
        ({"walls": ()}, "the plan is empty", True),
        ({"walls": (*OUTER, Wall((-2.0, 3.0), (3.0, 3.0)))}, "walls 4 and 5 cross", False),
        (
            {"walls": (Wall((0, 0), (1, 0), openings=(Opening("door", 0.5, 1.5),)),)},
            "wider than the wall",
            True,
        ),
        (
            {"walls": (Wall((0, 0), (2, 0), openings=(Opening("door", 1.8),)),)},
            "reaches beyond the end",
            True,
        ),
        (
            {"walls": (Wall((0, 0), (3, 0), openings=(Opening("door", 1.0), Opening("door", 1.5))),)},
            "two openings of wall 1 overlap",
            True,
        ),
        ({"walls": (Wall((0, 0), (0.01, 0)),)}, "shorter than", True),
        ({"places": (Place("shop", 4.0, 5.0),)}, "place shop is in a wall", True),
        ({"start": (4.0, 1.0)}, "the start is in a wall", True),
        ({"rooms": (Room("garden", 20.0, 20.0),)}, "no closed walls around the name garden", False),
        ({"rooms": (Room("a", 1, 1), Room("a", 6, 1))}, "the name a is given 2 times", True),
    ],
)
def test_a_problem_is_a_sentence_with_its_place(change, complaint, is_error):
    fields = {"walls": HOUSE.walls, "start": HOUSE.start, **change}
    found = [problem for problem in problems_of(HomePlan(**fields)) if complaint in problem.text]
    assert found, texts(HomePlan(**fields))
    assert found[0].is_error == is_error
    assert " at (" in str(found[0])


def test_a_place_in_a_doorway_is_allowed():
    assert texts(HomePlan(walls=HOUSE.walls, start=HOUSE.start, places=(Place("door", 4.0, 2.0),))) == []


def test_furniture_without_walls_is_a_plan():
    assert texts(HomePlan(furniture=(FurniturePiece("sofa", 2.0, 2.0, 0.0, (2.0, 0.9, 0.8)),))) == []
