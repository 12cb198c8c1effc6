"""The semantic map of a home: its rooms and furniture tops, with what is usually where."""

import math
import random
import re
from typing import Any, Dict, Mapping, Tuple

import shapely
import yaml
from shapely.geometry import Point as ShapelyPoint

from home_builder.palette import OUTLINE
from home_builder.plan.frames import plan_in_world
from home_builder.plan.geometry import furniture_polygon, room_faces
from home_builder.plan.model import FurniturePiece, HomePlan
from planar import Pose2
from planar.maps.semantic_map import FurnitureTop, ObjectPrior, SemanticMap

# Height of the surface as a share of the piece's; kinds that are not listed carry nothing.
SURFACES = {
    "bed": 0.55,
    "table": 1.0,
    "chair": 0.51,
    "shelf": 1.0,
    "sofa": 0.55,
    "kitchen": 1.0,
    "box": 1.0,
    OUTLINE: 1.0,
}
# Names of kinds, where they are others.
LABELS = {"kitchen": "kitchen unit", OUTLINE: "furniture"}
# Kind of a room by what its name contains; any other name is the kind, "room 1" is a "room".
ROOM_KINDS = {
    "kitchen": "kitchen",
    "dining": "dining room",
    "living": "living room",
    "bed": "bedroom",
    "bath": "bathroom",
    "hall": "hall",
    "corridor": "hall",
    "office": "office",
    "study": "office",
}
# What is usually where: weights of kinds of furniture, factors of kinds of rooms.
PRIORS: Dict[str, Tuple[Mapping[str, float], Mapping[str, float]]] = {
    "apple": ({"kitchen": 5, "table": 4, "shelf": 0.5}, {"kitchen": 3, "dining room": 2}),
    "book": (
        {"shelf": 5, "table": 2, "bed": 1.5, "sofa": 1.5},
        {"living room": 2, "bedroom": 2, "office": 2},
    ),
    "bottle": ({"kitchen": 4, "table": 4, "box": 0.5}, {"kitchen": 3, "dining room": 2}),
    "cup": ({"kitchen": 4, "table": 4, "shelf": 0.5}, {"kitchen": 3, "dining room": 2, "office": 1.5}),
    "glasses": ({"table": 3, "bed": 2, "shelf": 2, "sofa": 1}, {"bedroom": 2, "bathroom": 1.5}),
    "keys": ({"shelf": 3, "table": 3, "box": 1, "kitchen": 1}, {"hall": 4}),
    "laptop": ({"table": 5, "sofa": 1.5, "bed": 1}, {"office": 4, "living room": 1.5}),
    "letter": ({"table": 3, "shelf": 2, "box": 0.5}, {"hall": 3, "office": 2}),
    "medicine": ({"shelf": 3, "kitchen": 2, "table": 2}, {"bathroom": 4, "bedroom": 1.5}),
    "phone": ({"table": 3, "sofa": 2, "bed": 2, "kitchen": 1}, {"living room": 1.5, "bedroom": 1.5}),
    "plate": ({"kitchen": 5, "table": 4}, {"kitchen": 4, "dining room": 3}),
    "remote": ({"sofa": 5, "table": 3, "shelf": 1}, {"living room": 5}),
}
DIGITS = 3


def room_kind(name: str) -> str:
    """Return the kind of a room by its name."""
    plain = re.sub(r"[\d\s]+$", "", name.strip().lower())
    return next((kind for part, kind in ROOM_KINDS.items() if part in plain), plain or "room")


def default_priors() -> Dict[str, ObjectPrior]:
    """Return where common objects usually are."""
    return {name: ObjectPrior(name, on, rooms) for name, (on, rooms) in PRIORS.items()}


def semantic_map_of(plan: HomePlan) -> SemanticMap:
    """Return the semantic map of a plan, in the frame of world and map."""
    plan = plan_in_world(plan)
    faces = room_faces(plan)
    furniture: Dict[str, FurnitureTop] = {}
    for piece in plan.furniture:
        if piece.kind not in SURFACES:
            continue
        outline = furniture_polygon(piece)
        middle = outline.centroid
        room = next((face.name for face in faces if face.polygon.contains(ShapelyPoint(middle))), "")
        name = _free_name(piece, room, furniture)
        pose, size = _rectangle(piece)
        height = SURFACES[piece.kind] * piece.size[2]
        furniture[name] = FurnitureTop(name, piece.kind, room, pose, size, height)
    return SemanticMap({face.name: room_kind(face.name) for face in faces}, furniture, default_priors())


def _rectangle(piece: FurniturePiece) -> Tuple[Pose2, Tuple[float, float]]:
    """Return pose in the map and size of a piece; for an outline those of its least rectangle."""
    if piece.kind != OUTLINE:
        return Pose2(piece.x, piece.y, piece.yaw), (piece.size[0], piece.size[1])
    corners = list(shapely.oriented_envelope(furniture_polygon(piece)).exterior.coords)
    (x1, y1), (x2, y2), (x3, y3) = corners[:3]
    pose = Pose2((x1 + x3) / 2.0, (y1 + y3) / 2.0, math.atan2(y2 - y1, x2 - x1))
    return pose, (math.hypot(x2 - x1, y2 - y1), math.hypot(x3 - x2, y3 - y2))


def _free_name(piece: FurniturePiece, room: str, taken: Mapping[str, Any]) -> str:
    """Return ``table in kitchen``, or ``table 2 in kitchen``; a piece that has a name keeps it."""
    where = f" in {room}" if room else ""
    kind = LABELS.get(piece.kind, piece.kind)
    names = [piece.name] if piece.name else []
    numbers = ("", *(f" {number}" for number in range(2, len(taken) + 3)))
    names += [f"{piece.name or kind}{number}{where}" for number in numbers]
    return next(name for name in names if name not in taken)


def semantic_map_text(semantic_map: SemanticMap) -> str:
    """Return the text of a semantic map's file."""
    rooms = {name: {"kind": kind} for name, kind in semantic_map.rooms.items()}
    objects = {
        prior.name: {"on": dict(prior.on), "in": dict(prior.in_room)}
        for prior in semantic_map.objects.values()
    }
    furniture = {top.name: _top_entry(top) for top in semantic_map.furniture.values()}
    head = (
        "# Rooms, furniture, what is usually where; map frame, metres, radians. Edit it as you like.\n"
        "# Objects: weights of kinds of furniture, factors of kinds of rooms (docs/how_to/find_objects.md).\n"
    )
    return head + "".join(
        _section(key, table)
        for key, table in (("rooms", rooms), ("furniture", furniture), ("objects", objects))
    )


def _top_entry(top: FurnitureTop) -> Dict[str, Any]:
    room = {"room": top.room} if top.room else {}
    x, y, yaw = (round(each, DIGITS) + 0.0 for each in (top.pose.x, top.pose.y, top.pose.yaw))
    size = [round(each, DIGITS) for each in top.size]
    return {
        "kind": top.kind,
        **room,
        "x": x,
        "y": y,
        "yaw": yaw,
        "size": size,
        "height": round(top.height, DIGITS),
    }


def _section(key: str, table: Mapping[str, Any]) -> str:
    """Return a table with a line for each entry."""
    lines = [f"  {_flow({name: entry})[1:-1]}\n" for name, entry in table.items()]
    return "".join([f"{key}:\n", *lines]) if lines else f"{key}: {{}}\n"


def _flow(entry: Mapping[str, Any]) -> str:
    text = yaml.safe_dump(
        entry, sort_keys=False, default_flow_style=True, width=math.inf, allow_unicode=True
    ).strip()
    return str(text).replace("'on':", "on:")  # which YAML 1.1 reads as true, and our reader as a text


def objects_text(semantic_map: SemanticMap, name: str) -> str:
    """Return the text of a file that puts each object somewhere, drawn by its prior.

    Args:
        semantic_map: The semantic map.
        name: Name of the home, which seeds the draw.
    """
    rng = random.Random(name)
    head = (
        "# Where objects truly are, for the simulated detector and the judge; the robot does not read it.\n"
        "# NAME: {on: FURNITURE} or NAME: {x: X, y: Y, z: HEIGHT}, in the map frame.\n"
    )
    lines = []
    for each in semantic_map.objects if semantic_map.furniture else ():
        probabilities = semantic_map.probabilities(each)
        (on,) = rng.choices(list(probabilities), list(probabilities.values()))
        lines.append(f"{_flow({each: {'on': on}})[1:-1]}\n")
    return head + ("".join(lines) or "{}\n")
