"""What is wrong with a plan: each problem is one sentence and the point where it is."""

from collections import Counter
from dataclasses import dataclass
from itertools import combinations
from typing import Iterator, List

import shapely
from shapely.geometry import Point as ShapelyPoint

from home_builder.plan.geometry import (
    TOUCHING,
    doorway_polygons,
    furniture_polygon,
    room_faces,
    solid_polygons,
    wall_line,
)
from home_builder.plan.model import HomePlan, Wall

# Shortest wall [m].
MIN_LENGTH = 0.05
# Length below which an opening's edge is at the end of its wall [m].
ROUNDING = 1e-3
# Width of the narrowest door that the robot passes [m].
MIN_DOOR = 0.55
# Distance from the robot's centre to solids at a place [m].
ROBOT_RADIUS = 0.18


@dataclass(frozen=True)
class Problem:
    """A problem of a plan.

    Attributes:
        text: A sentence for people.
        x: Where it is, in the frame of the plan [m].
        y: Where it is [m].
        is_error: Whether no home can be built; else it is a warning.
    """

    text: str
    x: float
    y: float
    is_error: bool = True

    def __str__(self) -> str:
        return f"{self.text} at ({self.x:.2f}, {self.y:.2f})"


def problems_of(plan: HomePlan) -> List[Problem]:
    """Return all problems of a plan, errors first."""
    if not plan.walls and not plan.furniture:
        return [Problem("the plan is empty: draw walls, or import a map or a floor plan", *plan.start)]
    checks = (_wall_problems, _opening_problems, _crossings, _room_problems, _place_problems)
    problems = [problem for check in checks for problem in check(plan)]
    return sorted(problems, key=lambda problem: not problem.is_error)


def _wall_problems(plan: HomePlan) -> Iterator[Problem]:
    for number, wall in enumerate(plan.walls, 1):
        if wall.length < MIN_LENGTH:
            yield Problem(f"wall {number} is shorter than {MIN_LENGTH:g} m", *wall.start)


def _opening_problems(plan: HomePlan) -> Iterator[Problem]:
    for number, wall in enumerate(plan.walls, 1):
        for opening in wall.openings:
            where, name = wall.point_at(opening.at), f"a {opening.kind} in wall {number}"
            if opening.width > wall.length + ROUNDING:
                text = f"{name} is wider than the wall: {opening.width:.2f} of {wall.length:.2f} m"
                yield Problem(text, *where)
            elif opening.first < -ROUNDING or opening.last > wall.length + ROUNDING:
                yield Problem(f"{name} reaches beyond the end of the wall", *where)
            elif opening.bottom >= wall.height:
                yield Problem(f"{name} is above the wall, which is {wall.height:g} m high", *where)
            elif opening.kind == "door" and opening.width < MIN_DOOR:
                text = f"{name} is {opening.width:.2f} m wide; the robot needs {MIN_DOOR:g} m"
                yield Problem(text, *where, is_error=False)
        yield from _overlaps(number, wall)


def _overlaps(number: int, wall: Wall) -> Iterator[Problem]:
    ordered = sorted(wall.openings, key=lambda opening: opening.first)
    for one, other in zip(ordered, ordered[1:]):
        if one.last > other.first + ROUNDING:
            yield Problem(f"two openings of wall {number} overlap", *wall.point_at(other.at))


def _crossings(plan: HomePlan) -> Iterator[Problem]:
    """Walls whose centre lines cross; one that ends on another wall is a junction."""
    lines = [wall_line(wall) for wall in plan.walls]
    if not lines:
        return
    pairs = shapely.STRtree(lines).query(lines, predicate="crosses").T
    for one, other in sorted({(min(pair), max(pair)) for pair in pairs.tolist()}):
        where = lines[one].intersection(lines[other])
        ends = [
            ShapelyPoint(end)
            for wall in (plan.walls[one], plan.walls[other])
            for end in (wall.start, wall.end)
        ]
        slack = TOUCHING + max(plan.walls[one].thickness, plan.walls[other].thickness)
        if where.geom_type == "Point" and min(where.distance(end) for end in ends) > slack:
            yield Problem(f"walls {one + 1} and {other + 1} cross", where.x, where.y, is_error=False)


def _room_problems(plan: HomePlan) -> Iterator[Problem]:
    faces = room_faces(plan)
    doorways = shapely.STRtree(doorway_polygons(plan.walls))
    reach = max((wall.thickness for wall in plan.walls), default=0.0)
    for face in faces:
        if not len(doorways.query(face.polygon.buffer(reach), predicate="intersects")):
            where = face.polygon.representative_point()
            yield Problem(f"{face.name} has no door", where.x, where.y, is_error=False)
    for room in plan.rooms:
        if not any(face.polygon.contains(ShapelyPoint(room.x, room.y)) for face in faces):
            text = f"no closed walls around the name {room.name}"
            yield Problem(text, room.x, room.y, is_error=False)


def _place_problems(plan: HomePlan) -> Iterator[Problem]:
    solids = [*solid_polygons(plan.walls), *map(furniture_polygon, plan.furniture)]
    tree = shapely.STRtree(solids)
    points = [("the start", *plan.start), *((f"place {each.name}", each.x, each.y) for each in plan.places)]
    for name, x, y in points:
        if len(tree.query(ShapelyPoint(x, y), predicate="dwithin", distance=ROBOT_RADIUS)):
            yield Problem(f"{name} is in a wall or furniture, or too close to it", x, y)
    names = [(each.name, each.x, each.y) for each in plan.places]
    names += [(each.name, each.x, each.y) for each in plan.rooms]
    counts = Counter(name for name, _, _ in names)
    for name, x, y in {each[0]: each for each in names}.values():
        if counts[name] > 1:
            yield Problem(f"the name {name} is given {counts[name]} times", x, y)
    for one, other in combinations(plan.zones, 2):
        if one.name == other.name:
            yield Problem(f"the name of zone {one.name} is given twice", *one.corners[0])
