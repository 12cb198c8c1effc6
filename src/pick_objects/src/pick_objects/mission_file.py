"""Mission files: YAML; all mistakes are reported at once, with file, line and key."""

from dataclasses import fields
from pathlib import Path
from typing import Collection, Dict, List, Mapping, Optional, Sequence, Set, Tuple, Union

from pick_objects.config import ErrandSettings
from pick_objects.mission import ORANGE, Delivery, Mission, MissionObject
from planar.config.error_list import ErrorList, read_each
from planar.config.hints import hint_or_choices
from planar.config.settings import settings_from
from planar.config.yaml_table import Table, parse_table, read_table
from planar.geometry.grid import OccupancyGrid
from planar.maps.places import NamedPlace, obstruction_at, parse_place
from planar.maps.semantic_map import SemanticMap

Places = Mapping[str, NamedPlace]
MAX_SOLID_SIZE = 0.25
TEXT_SOURCE = "mission"  # in messages, where the file's name would be


def load_mission(
    path: Union[str, Path],
    known_places: Places = {},
    defaults: ErrandSettings = ErrandSettings(),
    grid: Optional[OccupancyGrid] = None,
    semantic_map: Optional[SemanticMap] = None,
) -> Mission:
    """Read a mission file.

    Args:
        path: YAML file.
        known_places: Places that it may refer to in addition to its own.
        defaults: Settings that it leaves out.
        grid: Map in which all its places must be free; None: not checked.
        semantic_map: What can be searched; None: not checked.

    Raises:
        SettingsError: With file, line and key.
    """
    return _mission(read_table(path), str(path), known_places, defaults, grid, semantic_map)


def parse_mission(
    text: str,
    known_places: Places = {},
    defaults: ErrandSettings = ErrandSettings(),
    grid: Optional[OccupancyGrid] = None,
    semantic_map: Optional[SemanticMap] = None,
) -> Mission:
    """Parse the text of a mission file; see load_mission."""
    return _mission(parse_table(text, TEXT_SOURCE), TEXT_SOURCE, known_places, defaults, grid, semantic_map)


def _mission(
    table: Table,
    source: str,
    known_places: Places,
    defaults: ErrandSettings,
    grid: Optional[OccupancyGrid],
    semantic_map: Optional[SemanticMap],
) -> Mission:
    # ``faults`` are read by the simulator.
    errors = ErrorList()
    errors.read(table.allow_only, "name", "places", "objects", "settings", "deliveries", "faults")
    name = errors.read(table.text, "name", Path(source).stem) or ""
    places = errors.read(_places, table, grid) or {}
    objects = errors.read(_objects, table) or {}
    settings = errors.read(_settings, table, defaults) or defaults
    # The names of those that could not be read are known as well.
    place_names = {**known_places, **dict.fromkeys(_keys(table, "places"))}
    deliveries = errors.read(_deliveries, table, place_names, _keys(table, "objects")) or ()
    mission = Mission(name, {**known_places, **places}, deliveries, objects, settings)
    errors.read(_check_searches, table, mission, semantic_map)
    errors.raise_all()
    return mission


def _keys(table: Table, key: str) -> List[str]:
    """The keys of the table under a key; none if there is no such table."""
    return list(ErrorList().read(table.table, key) or ())


def _places(table: Table, grid: Optional[OccupancyGrid]) -> Dict[str, NamedPlace]:
    if "places" not in table:
        return {}
    places_table = table.table("places")

    def read(name: str) -> NamedPlace:
        place = parse_place(places_table, name)
        if grid is not None:
            _check_free(place, places_table.table(name), grid)
        return place

    return {place.name: place for place in read_each(read, places_table)}


def _check_free(place: NamedPlace, entry: Table, grid: OccupancyGrid) -> None:
    for part, pose in zip([entry, *entry.tables("approaches")], place.poses):
        obstruction = obstruction_at(pose, grid)
        if obstruction:
            raise part.error_at("x", f"and y: ({pose.x:g}, {pose.y:g}) {obstruction}")


def _objects(table: Table) -> Dict[str, MissionObject]:
    if "objects" not in table:
        return {}
    entries = table.table("objects")
    objects = read_each(lambda name: _object(entries.table(name), name), entries)
    return {each.name: each for each in objects}


def _object(entry: Table, name: str) -> MissionObject:
    entry.allow_only("size", "color", "solid")
    size = entry.number("size", MissionObject(name).size)
    entry.check(size > 0.0, "size", "positive")
    color = entry.numbers("color", "red, green, blue") if "color" in entry else ORANGE
    entry.check(all(0.0 <= share <= 1.0 for share in color), "color", "three numbers from 0 to 1")
    solid = entry.flag("solid", False)
    if solid:
        entry.check(size <= MAX_SOLID_SIZE, "size", f"at most {MAX_SOLID_SIZE}, that the robot can carry it")
    return MissionObject(name, size, color, solid)  # type: ignore[arg-type]


def _settings(table: Table, defaults: ErrandSettings) -> ErrandSettings:
    if "settings" not in table:
        return defaults
    entry = table.table("settings")
    entry.allow_only(*(field.name for field in fields(ErrandSettings)))
    settings, _ = settings_from(ErrandSettings, {**vars(defaults), **entry.values()}, where=entry.location_of)
    return settings


def _deliveries(table: Table, places: Collection[str], objects: Collection[str]) -> Tuple[Delivery, ...]:
    entries = table.tables("deliveries")
    if not entries:
        raise table.error_at("deliveries", "are missing: [{object: ..., from: ..., to: ...}]")
    numbered = enumerate(entries, 1)
    deliveries = read_each(lambda item: _delivery(item[1], item[0], places, objects), numbered)
    lines: Dict[str, Table] = {}
    for delivery, entry in zip(deliveries, entries):
        if delivery.name in lines:
            raise entry.error_at("name", f"{delivery.name} is that of another delivery already")
        lines[delivery.name] = entry
    read_each(lambda each: _check_name(lines[each.name], "after", each.after, lines, "delivery"), deliveries)
    _check_cycles(deliveries, lines)
    _check_object_locations(deliveries, lines)
    return deliveries


def _delivery(entry: Table, number: int, places: Collection[str], objects: Collection[str]) -> Delivery:
    errors = ErrorList()
    is_find = "find" in entry
    keys = ("find",) if is_find else ("object", "from", "to")
    errors.read(entry.allow_only, "name", *keys, "after", "goal_timeout")
    source, destination = (
        errors.read(_text_of, entry, key, places, "place") or "" if needed else ""
        for key, needed in (("from", not is_find and "from" in entry), ("to", not is_find))
    )
    object_name = errors.read(_text_of, entry, "find" if is_find else "object", objects, "object") or ""
    if source:
        errors.read(entry.check, source != destination, "to", f"another place than {source}")
    timeout = errors.read(entry.number, "goal_timeout") if "goal_timeout" in entry else None
    errors.read(entry.check, timeout is None or timeout > 0.0, "goal_timeout", "positive")
    errors.raise_all()
    name = entry.text("name", f"delivery {number}")
    return Delivery(name, object_name, source, destination, tuple(entry.texts("after")), timeout)


def _check_searches(table: Table, mission: Mission, semantic_map: Optional[SemanticMap]) -> None:
    """Refuse searches of objects that the semantic map does not list, and those that cannot be ordered."""
    for delivery, entry in zip(mission.deliveries, table.tables("deliveries") if mission.deliveries else ()):
        key = "object" if delivery.destination else "find"
        if not delivery.source and mission.settings.order == "shortest":
            raise entry.error_at(key, "has no from, which the order shortest needs")
        if not mission.is_searched(delivery):
            continue
        problem = semantic_map.problem_with(delivery.object_name) if semantic_map is not None else ""
        if problem:
            raise entry.error_at(key, f"cannot be searched: {problem}")


def _text_of(entry: Table, key: str, known: Collection[str], kind: str) -> str:
    """The text of a key, which is one of the known names unless there are none."""
    text = entry.text(key)
    if known:
        _check_name(entry, key, [text], known, kind)
    return text


def _check_name(entry: Table, key: str, names, known, kind: str) -> None:
    for name in names:
        if name not in known:
            raise entry.error_at(key, f"names no {kind}: {name}{hint_or_choices(name, known)}")


def _check_cycles(deliveries: Sequence[Delivery], lines: Mapping[str, Table]) -> None:
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


def _check_object_locations(deliveries: Sequence[Delivery], lines: Mapping[str, Table]) -> None:
    """Refuse a delivery whose object was left elsewhere by the one before."""
    left_at: Dict[str, Delivery] = {}
    for delivery in deliveries:
        last = left_at.get(delivery.object_name)
        if last is not None and delivery.source and last.destination not in ("", delivery.source):
            where = f"{last.destination}, where {last.name} leaves {delivery.object_name}"
            lines[delivery.name].check(False, "from", where)
        left_at[delivery.object_name] = delivery
