"""The plan's own file: YAML that is read back without loss."""

import math
from dataclasses import asdict
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

import yaml

from home_builder.palette import KINDS, OUTLINE
from home_builder.plan.model import (
    EDGES,
    KEEP_OUT,
    OPENING_KINDS,
    PLACE_RADIUS,
    SPEED,
    WALL_HEIGHT,
    WALL_THICKNESS,
    FurniturePiece,
    HomePlan,
    Opening,
    Place,
    Point,
    Room,
    Template,
    Wall,
    Zone,
)
from planar.config.yaml_table import Table, parse_table, read_table

LISTS = ("walls", "furniture", "rooms", "places", "zones")
# Largest coordinate and length of a plan [m], and the most walls or pieces of furniture in one.
MAX_COORDINATE, MAX_COUNT = 1000.0, 5000


def load_plan(path) -> HomePlan:
    """Read a plan.

    Raises:
        SettingsError: With file, line and key.
    """
    return _plan(read_table(path))


def parse_plan(text: str, source: str = "plan") -> HomePlan:
    """Parse the text of a plan file. Raises SettingsError with line and key; ``source`` names the text."""
    return _plan(parse_table(text, source))


def _plan(table: Table) -> HomePlan:
    table.allow_only(
        "name", "start", "start_yaw", "walls", "furniture", "rooms", "places", "zones", "template"
    )
    for key in LISTS:
        count = len(table.tables(key))
        table.check(count <= MAX_COUNT, key, f"at most {MAX_COUNT} entries")
    return HomePlan(
        table.text("name", "home"),
        tuple(map(_wall, table.tables("walls"))),
        tuple(map(_furniture, table.tables("furniture"))),
        tuple(map(_room, table.tables("rooms"))),
        tuple(map(_place, table.tables("places"))),
        tuple(map(_zone, table.tables("zones"))),
        _point(table, "start") if "start" in table else (0.0, 0.0),
        _coordinate(table, "start_yaw", 0.0),
        _template(table.table("template")) if "template" in table else None,
    )


def _coordinate(table: Table, key: str, default: Optional[float] = None) -> float:
    value = table.number(key) if default is None else table.number(key, default)
    table.check(abs(value) <= MAX_COORDINATE, key, f"within {MAX_COORDINATE:g} m of the origin")
    return value


def _length(table: Table, key: str, default: float) -> float:
    value = table.number(key, default)
    table.check(0.0 < value <= MAX_COORDINATE, key, f"positive, at most {MAX_COORDINATE:g} m")
    return value


def _point(table: Table, key: str) -> Point:
    x, y = table.numbers(key, "x, y")
    is_near = max(abs(x), abs(y)) <= MAX_COORDINATE
    table.check(is_near, key, f"within {MAX_COORDINATE:g} m of the origin")
    return x, y


def _points(table: Table, key: str) -> Tuple[Point, ...]:
    value = table.value(key)
    try:
        points = tuple((float(x), float(y)) for x, y in value)
    except (TypeError, ValueError, OverflowError):
        points = ()
    is_outline = len(points) >= 3 and all(abs(each) <= MAX_COORDINATE for point in points for each in point)
    table.check(is_outline, key, "at least 3 points [x, y]")
    return points


def _wall(table: Table) -> Wall:
    table.allow_only("start", "end", "thickness", "height", "openings")
    return Wall(
        _point(table, "start"),
        _point(table, "end"),
        _length(table, "thickness", WALL_THICKNESS),
        _length(table, "height", WALL_HEIGHT),
        tuple(map(_opening, table.tables("openings"))),
    )


def _opening(table: Table) -> Opening:
    table.allow_only("kind", "at", "width", "bottom", "top")
    kind = table.choice("kind", OPENING_KINDS)
    bottom, top = EDGES[kind]
    opening = Opening(
        kind,
        _coordinate(table, "at"),
        _length(table, "width", 0.9),
        _coordinate(table, "bottom", bottom),
        _coordinate(table, "top", top),
    )
    table.check(0.0 <= opening.bottom < opening.top, "top", "above bottom")
    return opening


def _furniture(table: Table) -> FurniturePiece:
    table.allow_only("kind", "x", "y", "yaw", "size", "name", "corners")
    kind = table.choice("kind", (*KINDS, OUTLINE))
    width, depth, height = (
        table.numbers("size", "width, depth, height")
        if "size" in table
        else KINDS.get(kind, KINDS["box"]).size
    )
    is_size = all(0.0 < side <= MAX_COORDINATE for side in (width, depth, height))
    table.check(is_size, "size", "three positive lengths")
    return FurniturePiece(
        kind,
        _coordinate(table, "x"),
        _coordinate(table, "y"),
        _coordinate(table, "yaw", 0.0),
        (width, depth, height),
        table.text("name") if "name" in table else "",
        _points(table, "corners") if kind == OUTLINE else (),
    )


def _room(table: Table) -> Room:
    table.allow_only("name", "x", "y")
    return Room(table.text("name"), _coordinate(table, "x"), _coordinate(table, "y"))


def _place(table: Table) -> Place:
    table.allow_only("name", "x", "y", "yaw", "radius")
    return Place(
        table.text("name"),
        _coordinate(table, "x"),
        _coordinate(table, "y"),
        _coordinate(table, "yaw", 0.0),
        _length(table, "radius", PLACE_RADIUS),
    )


def _zone(table: Table) -> Zone:
    table.allow_only("name", "kind", "corners", "max_speed")
    kind = table.choice("kind", (KEEP_OUT, SPEED))
    speed = _length(table, "max_speed", 0.2) if kind == SPEED else math.inf
    return Zone(table.text("name"), kind, _points(table, "corners"), speed)


def _template(table: Table) -> Template:
    table.allow_only("file", "x", "y", "scale", "width", "height")
    name = table.text("file")
    table.check(Path(name).name == name, "file", "a file of the folder itself")
    return Template(
        name,
        _coordinate(table, "x"),
        _coordinate(table, "y"),
        _length(table, "scale", 1.0),
        table.count("width"),
        table.count("height"),
    )


def plan_entries(plan: HomePlan) -> Dict[str, Any]:
    """Return a plan as tables, lists and numbers, as in its file and in JSON."""
    entries: Dict[str, Any] = {
        "name": plan.name,
        "start": list(plan.start),
        "start_yaw": plan.start_yaw,
        "walls": [_wall_entry(wall) for wall in plan.walls],
        "furniture": [_furniture_entry(piece) for piece in plan.furniture],
        "rooms": [{"name": room.name, "x": room.x, "y": room.y} for room in plan.rooms],
        "places": [
            {"name": each.name, "x": each.x, "y": each.y, "yaw": each.yaw, "radius": each.radius}
            for each in plan.places
        ],
        "zones": [_zone_entry(zone) for zone in plan.zones],
    }
    if plan.template is not None:
        entries["template"] = asdict(plan.template)
    return entries


def plan_text(plan: HomePlan) -> str:
    """Return the text of a plan file; ``parse_plan`` returns an equal plan."""
    entries = plan_entries(plan)
    content = {key: value for key, value in entries.items() if not isinstance(value, list) or key == "start"}
    head = "# The plan of a home: metres and radians. ./scripts/build_home.sh FOLDER builds it again.\n"
    lines = [
        head,
        yaml.safe_dump(content, sort_keys=False, default_flow_style=None, allow_unicode=True),
    ]
    for key in LISTS:
        lines += _list_lines(key, entries[key])
    return "".join(lines)


def _list_lines(key: str, entries: List[Dict[str, Any]]) -> List[str]:
    """One line an entry, so that changes of a plan are easy to compare."""
    if not entries:
        return []
    texts = (
        yaml.safe_dump(
            entry, sort_keys=False, default_flow_style=True, width=math.inf, allow_unicode=True
        ).strip()
        for entry in entries
    )
    return [f"{key}:\n", *(f"  - {text}\n" for text in texts)]


def _wall_entry(wall: Wall) -> Dict[str, Any]:
    entry: Dict[str, Any] = {"start": list(wall.start), "end": list(wall.end)}
    entry.update(thickness=wall.thickness, height=wall.height)
    if wall.openings:
        entry["openings"] = [
            {"kind": each.kind, "at": each.at, "width": each.width, "bottom": each.bottom, "top": each.top}
            for each in wall.openings
        ]
    return entry


def _furniture_entry(piece: FurniturePiece) -> Dict[str, Any]:
    entry: Dict[str, Any] = {"kind": piece.kind, "x": piece.x, "y": piece.y, "yaw": piece.yaw}
    entry["size"] = list(piece.size)
    if piece.name:
        entry["name"] = piece.name
    if piece.corners:
        entry["corners"] = [list(corner) for corner in piece.corners]
    return entry


def _zone_entry(zone: Zone) -> Dict[str, Any]:
    entry: Dict[str, Any] = {"name": zone.name, "kind": zone.kind}
    entry["corners"] = [list(corner) for corner in zone.corners]
    if zone.kind == SPEED:
        entry["max_speed"] = zone.max_speed
    return entry
