"""Mission files: YAML; every mistake is reported with file, line and key."""

from dataclasses import fields
from pathlib import Path
from typing import Dict, List, Mapping, Optional, Set, Tuple, Union

from pick_objects.config import ErrandSettings
from pick_objects.mission import ORANGE, Delivery, Mission, MissionObject
from planar.config.hints import hint_or_choices
from planar.config.settings import settings_from
from planar.config.yaml_table import Table, parse_table, read_table
from planar.geometry.grid import OccupancyGrid
from planar.maps.places import NamedPlace, obstruction_at, parse_place

Places = Mapping[str, NamedPlace]
MAX_SOLID_SIZE = 0.25
TEXT_SOURCE = "mission"  # in messages, where the file's name would be


def load_mission(
    path: Union[str, Path],
    known_places: Places = {},
    defaults: ErrandSettings = ErrandSettings(),
    grid: Optional[OccupancyGrid] = None,
) -> Mission:
    """Read a mission file.

    Args:
        path: YAML file.
        known_places: Places that it may refer to in addition to its own.
        defaults: Settings that it leaves out.
        grid: Map in which all its places must be free; None: not checked.

    Raises:
        SettingsError: With file, line and key.
    """
    return _mission(read_table(path), str(path), known_places, defaults, grid)


def parse_mission(
    text: str,
    known_places: Places = {},
    defaults: ErrandSettings = ErrandSettings(),
    grid: Optional[OccupancyGrid] = None,
) -> Mission:
    """Parse the text of a mission file; see load_mission."""
    return _mission(parse_table(text, TEXT_SOURCE), TEXT_SOURCE, known_places, defaults, grid)


def _mission(
    table: Table,
    source: str,
    known_places: Places,
    defaults: ErrandSettings,
    grid: Optional[OccupancyGrid],
) -> Mission:
    # ``faults`` are read by the simulator.
    table.allow_only("name", "places", "objects", "settings", "deliveries", "faults")
    name = table.text("name", Path(source).stem)
    places = {**known_places, **_places(table, grid)}
    objects = _objects(table)
    settings = _settings(table, defaults)
    deliveries = _deliveries(table, places, objects)
    return Mission(name, places, deliveries, objects, settings)


def _places(table: Table, grid: Optional[OccupancyGrid]) -> Dict[str, NamedPlace]:
    if "places" not in table:
        return {}
    places_table = table.table("places")
    places = {name: parse_place(places_table, name) for name in places_table}
    if grid is not None:
        for place in places.values():
            _check_free(place, places_table.table(place.name), grid)
    return places


def _check_free(place: NamedPlace, entry: Table, grid: OccupancyGrid) -> None:
    for part, pose in zip([entry, *entry.tables("approaches")], place.poses):
        obstruction = obstruction_at(pose, grid)
        if obstruction:
            raise part.error_at("x", f"and y: ({pose.x:g}, {pose.y:g}) {obstruction}")


def _objects(table: Table) -> Dict[str, MissionObject]:
    if "objects" not in table:
        return {}
    entries, objects = table.table("objects"), {}
    for name in entries:
        entry = entries.table(name)
        entry.allow_only("size", "color", "solid")
        size = entry.number("size", MissionObject(name).size)
        entry.check(size > 0.0, "size", "positive")
        color = entry.numbers("color", "red, green, blue") if "color" in entry else ORANGE
        entry.check(all(0.0 <= share <= 1.0 for share in color), "color", "three numbers from 0 to 1")
        solid = entry.flag("solid", False)
        if solid:
            entry.check(
                size <= MAX_SOLID_SIZE, "size", f"at most {MAX_SOLID_SIZE}, that the robot can carry it"
            )
        objects[name] = MissionObject(name, size, color, solid)  # type: ignore[arg-type]
    return objects


def _settings(table: Table, defaults: ErrandSettings) -> ErrandSettings:
    if "settings" not in table:
        return defaults
    entry = table.table("settings")
    entry.allow_only(*(field.name for field in fields(ErrandSettings)))
    settings, _ = settings_from(ErrandSettings, {**vars(defaults), **entry.values()}, where=entry.location_of)
    return settings


def _deliveries(table: Table, places: Places, objects: Mapping[str, MissionObject]) -> Tuple[Delivery, ...]:
    entries = table.tables("deliveries")
    if not entries:
        raise table.error_at("deliveries", "are missing: [{object: ..., from: ..., to: ...}]")
    deliveries: List[Delivery] = []
    lines: Dict[str, Table] = {}
    for number, entry in enumerate(entries, 1):
        delivery = _delivery(entry, number, places, objects)
        if delivery.name in lines:
            raise entry.error_at("name", f"{delivery.name} is that of another delivery already")
        lines[delivery.name] = entry
        deliveries.append(delivery)
    for delivery in deliveries:
        _check_name(lines[delivery.name], "after", delivery.after, lines, "delivery")
    _check_cycles(deliveries, lines)
    _check_object_locations(deliveries, lines)
    return tuple(deliveries)


def _delivery(entry: Table, number: int, places: Places, objects: Mapping[str, MissionObject]) -> Delivery:
    entry.allow_only("name", "object", "from", "to", "after", "goal_timeout")
    object_name, source, destination = (entry.text(key) for key in ("object", "from", "to"))
    _check_name(entry, "from", [source], places, "place")
    _check_name(entry, "to", [destination], places, "place")
    if objects:
        _check_name(entry, "object", [object_name], objects, "object")
    entry.check(source != destination, "to", f"another place than {source}")
    timeout = entry.number("goal_timeout") if "goal_timeout" in entry else None
    entry.check(timeout is None or timeout > 0.0, "goal_timeout", "positive")
    name = entry.text("name", f"delivery {number}")
    return Delivery(name, object_name, source, destination, tuple(entry.texts("after")), timeout)


def _check_name(entry: Table, key: str, names, known, kind: str) -> None:
    for name in names:
        if name not in known:
            raise entry.error_at(key, f"names no {kind}: {name}{hint_or_choices(name, known)}")


def _check_cycles(deliveries: List[Delivery], lines: Mapping[str, Table]) -> None:
    """Refuse deliveries that wait for each other, also because they carry the same object on."""
    waits_for: Dict[str, Set[str]] = {}
    latest_of_object: Dict[str, str] = {}
    for delivery in deliveries:
        waits_for[delivery.name] = set(delivery.after)
        if delivery.object_name in latest_of_object:
            waits_for[delivery.name].add(latest_of_object[delivery.object_name])
        latest_of_object[delivery.object_name] = delivery.name
    awaited_by: Dict[str, List[str]] = {name: [] for name in waits_for}
    for name, others in waits_for.items():
        for other in others:
            awaited_by[other].append(name)
    free = [name for name, others in waits_for.items() if not others]
    while free:  # Kahn's algorithm
        done = free.pop()
        del waits_for[done]
        for name in awaited_by[done]:
            waits_for[name].remove(done)
            if not waits_for[name]:
                free.append(name)
    if waits_for:
        name = next(name for name in waits_for if waits_for.keys() & lines[name].texts("after"))
        raise lines[name].error_at("after", f"makes a cycle: {', '.join(waits_for)} wait for each other")


def _check_object_locations(deliveries: List[Delivery], lines: Mapping[str, Table]) -> None:
    """Refuse a delivery whose object was left elsewhere by the one before."""
    left_at: Dict[str, Delivery] = {}
    for delivery in deliveries:
        last = left_at.get(delivery.object_name)
        if last is not None and last.destination != delivery.source:
            where = f"{last.destination}, where {last.name} leaves {delivery.object_name}"
            lines[delivery.name].check(False, "from", where)
        left_at[delivery.object_name] = delivery
