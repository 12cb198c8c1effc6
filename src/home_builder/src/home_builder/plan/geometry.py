"""Shapes of a plan: polygons of walls and furniture, rooms as closed faces."""

import math
from dataclasses import dataclass
from typing import Dict, Iterable, List, Sequence, Tuple

import numpy as np
import shapely
from shapely import affinity
from shapely.geometry import LineString, MultiPolygon, Polygon
from shapely.geometry import Point as ShapelyPoint

from home_builder.palette import OUTLINE
from home_builder.plan.model import DOOR, FurniturePiece, HomePlan, Point, Wall

# Gap between walls that still closes a room [m], and the smallest room [m2].
CLOSING_GAP, MIN_ROOM_AREA = 0.1, 0.8
# The same where furniture closes gaps of walls, as on a map: walls behind it were not seen.
FURNITURE_GAP, MIN_FURNISHED_AREA = 0.3, 2.0
# Length below which a part of a wall is left out, and height of the robot [m].
NEGLIGIBLE, ROBOT_HEIGHT = 1e-3, 0.5
# Distance within which the end of a wall is on another wall's centre line [m].
TOUCHING = 0.02


@dataclass(frozen=True)
class RoomFace:
    """A room that walls enclose.

    Attributes:
        name: Its name in the plan, or ``room 1``, ``room 2``, ... by area.
        polygon: Its floor.
    """

    name: str
    polygon: Polygon


def wall_line(wall: Wall) -> LineString:
    """Return the centre line of a wall."""
    return LineString([wall.start, wall.end])


def end_extensions(walls: Sequence[Wall]) -> List[Tuple[float, float]]:
    """Return by how much each wall is longer than its centre line at start and end [m].

    A wall that ends on the centre line of another one is extended to its far face, so that corners close.
    """
    if not walls:
        return []
    extensions = np.zeros((len(walls), 2))
    ends = shapely.points([end for wall in walls for end in (wall.start, wall.end)])
    tree = shapely.STRtree([wall_line(wall) for wall in walls])
    ends_met, walls_met = tree.query(ends, predicate="dwithin", distance=TOUCHING)
    for number, other in zip(ends_met.tolist(), walls_met.tolist()):
        index, side = divmod(number, 2)
        if index == other or _are_parallel(walls[index], walls[other]):
            continue
        extensions[index, side] = max(extensions[index, side], walls[other].thickness / 2.0)
    return [(float(start), float(end)) for start, end in extensions]


def _are_parallel(one: Wall, other: Wall) -> bool:
    return abs(math.sin(one.yaw - other.yaw)) < 0.1


def wall_polygons(walls: Sequence[Wall]) -> List[Polygon]:
    """Return the footprint of each wall, without its openings."""
    return [
        section(wall, -before, wall.length + after)
        for wall, (before, after) in zip(walls, end_extensions(walls))
    ]


def solid_polygons(walls: Sequence[Wall]) -> List[Polygon]:
    """Return the footprints of what is solid of walls at the height of the robot: they end at doors."""
    return [
        section(wall, first, last)
        for wall, extension in zip(walls, end_extensions(walls))
        for first, last, bottom, _ in wall_blocks(wall, *extension)
        if bottom < ROBOT_HEIGHT
    ]


def wall_blocks(
    wall: Wall, before: float = 0.0, after: float = 0.0
) -> List[Tuple[float, float, float, float]]:
    """Return the blocks around the openings of a wall.

    Args:
        wall: The wall.
        before: Length added at its start [m].
        after: Length added at its end [m].

    Returns:
        First and last distance from the start, bottom and top of each block [m].
    """
    blocks: List[Tuple[float, float, float, float]] = []
    solid_from = -before
    for opening in sorted(wall.openings, key=lambda each: each.first):
        first, last = max(opening.first, 0.0), min(opening.last, wall.length)
        # An opening that reaches an end leaves nothing of the extension there either.
        first = -before if first < NEGLIGIBLE else first
        last = wall.length + after if last > wall.length - NEGLIGIBLE else last
        blocks.append((solid_from, first, 0.0, wall.height))
        blocks.append((first, last, 0.0, opening.bottom))
        blocks.append((first, last, opening.top, wall.height))
        solid_from = last
    blocks.append((solid_from, wall.length + after, 0.0, wall.height))
    return [
        block for block in blocks if block[1] - block[0] > NEGLIGIBLE and block[3] - block[2] > NEGLIGIBLE
    ]


def section(wall: Wall, first: float, last: float) -> Polygon:
    """Return the footprint of a wall between two distances from its start [m]."""
    (x1, y1), (x2, y2) = wall.point_at(first), wall.point_at(last)
    half = wall.thickness / 2.0
    across_x, across_y = -half * math.sin(wall.yaw), half * math.cos(wall.yaw)
    return Polygon(
        [
            (x1 + across_x, y1 + across_y),
            (x1 - across_x, y1 - across_y),
            (x2 - across_x, y2 - across_y),
            (x2 + across_x, y2 + across_y),
        ]
    )


def doorway_polygons(walls: Iterable[Wall]) -> List[Polygon]:
    """Return the floor of each door."""
    return [
        section(wall, opening.first, opening.last)
        for wall in walls
        for opening in wall.openings
        if opening.kind == DOOR
    ]


def furniture_polygon(piece: FurniturePiece) -> Polygon:
    """Return the footprint of a piece of furniture."""
    width, depth, _ = piece.size
    corners: Sequence[Point] = piece.corners
    if piece.kind != OUTLINE:
        x, y = width / 2.0, depth / 2.0
        corners = [(-x, -y), (x, -y), (x, y), (-x, y)]
    turned = affinity.rotate(Polygon(corners), piece.yaw, origin=(0.0, 0.0), use_radians=True)
    return affinity.translate(turned, piece.x, piece.y)


def room_faces(plan: HomePlan) -> List[RoomFace]:
    """Return the rooms that are enclosed, doors being closed, the largest first.

    Walls enclose a room; where they have gaps, furniture may close them.
    """
    if not plan.walls:
        return []
    walls = wall_polygons(plan.walls)
    faces = _holes(walls, CLOSING_GAP, MIN_ROOM_AREA)
    if plan.furniture:
        solids = [*walls, *map(furniture_polygon, plan.furniture)]
        enclosed = shapely.union_all(faces)
        faces += [
            face
            for face in _holes(solids, FURNITURE_GAP, MIN_FURNISHED_AREA)
            if not enclosed.intersects(face.representative_point())
        ]
    faces.sort(key=lambda face: (-face.area, *face.bounds))
    return _named(plan, faces)


def _holes(solids: Sequence[Polygon], gap: float, min_area: float) -> List[Polygon]:
    """Return the faces that solids enclose, with gaps between them of up to ``gap`` closed."""
    union = shapely.union_all([polygon.buffer(gap / 2.0) for polygon in solids])
    rings = [Polygon(ring) for polygon in _polygons_of(union) for ring in polygon.interiors]
    # A column or an inner ring of walls stands in the hole of another polygon.
    holes = [ring.difference(union).buffer(gap / 2.0, join_style="mitre") for ring in rings]
    return [face for hole in holes for face in _polygons_of(hole) if face.area >= min_area]


def _polygons_of(geometry) -> List[Polygon]:
    return list(geometry.geoms) if isinstance(geometry, MultiPolygon) else [geometry]


def _named(plan: HomePlan, faces: Sequence[Polygon]) -> List[RoomFace]:
    taken = {room.name for room in plan.rooms}
    numbers = (number for number in range(1, len(faces) + len(taken) + 1) if f"room {number}" not in taken)
    names: Dict[int, str] = {}
    for room in plan.rooms:
        for index, face in enumerate(faces):
            if index not in names and face.contains(ShapelyPoint(room.x, room.y)):
                names[index] = room.name
                break
    return [RoomFace(names.get(index) or f"room {next(numbers)}", face) for index, face in enumerate(faces)]


def corners_of(polygon: Polygon) -> np.ndarray:
    """Return the corners (N, 2) of a polygon's outline, without the repeated first one [m]."""
    return np.asarray(polygon.exterior.coords)[:-1]
