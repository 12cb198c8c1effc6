"""Semantic map: rooms, furniture, and what is usually where; and a file of where objects truly are.

The file of objects is for the simulated sensor and for judging, never for the robot.
"""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Dict, Mapping, Tuple

import numpy as np

from planar.config.error_list import ErrorList, read_each
from planar.config.hints import hint_or_choices
from planar.config.yaml_table import Table, read_table
from planar.errors import SettingsError
from planar.geometry.pose import Pose2

# Probability that an object is on any piece of furniture, whatever the prior is.
UNEXPECTED = 0.1
# Distance between points of a furniture top [m].
POINT_SPACING = 0.35
# Height at which objects stand in shelves, whose tops are higher [m].
SHELF_HEIGHT = 1.0
SEMANTIC_MAP, OBJECTS = "semantic_map.yaml", "objects.yaml"


@dataclass(frozen=True)
class FurnitureTop:
    """A surface on which objects stand.

    Attributes:
        name: Unique name, such as ``table in kitchen``.
        kind: Kind of furniture.
        room: Name of its room; empty if it is in none.
        pose: Pose of its middle in the map.
        size: Width along its x axis and depth along its y axis [m].
        height: Height of the surface above the floor; of a shelf that of its top [m].
    """

    name: str
    kind: str
    room: str
    pose: Pose2
    size: Tuple[float, float]
    height: float

    def points_xy(self) -> np.ndarray:
        """Return evenly spaced points (N, 2) of the surface in the map [m]."""
        counts = [max(1, round(side / POINT_SPACING)) for side in self.size]
        x, y = (
            (np.arange(count) + 0.5) / count * side - side / 2.0 for count, side in zip(counts, self.size)
        )
        grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        return self.pose.transform_points(grid)

    def distance_to(self, x: float, y: float) -> float:
        """Return the distance from a point of the map to the surface [m]; 0 on it."""
        here = self.pose.inverse() @ Pose2(x, y)
        across = (abs(here.x) - self.size[0] / 2.0, abs(here.y) - self.size[1] / 2.0)
        return math.hypot(*(max(each, 0.0) for each in across))


@dataclass(frozen=True)
class ObjectPrior:
    """Where a kind of object usually is.

    Attributes:
        name: Name of the object.
        on: Weight of each kind of furniture; others have 0.
        in_room: Factor for each kind of room; others have 1.
    """

    name: str
    on: Mapping[str, float]
    in_room: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class SemanticMap:
    """Rooms, furniture, and what is usually where.

    Attributes:
        rooms: Kind of each room, by name.
        furniture: Furniture tops by name.
        objects: Priors by the name of the object.
        source: File, for messages.
    """

    rooms: Mapping[str, str]
    furniture: Mapping[str, FurnitureTop]
    objects: Mapping[str, ObjectPrior]
    source: str = SEMANTIC_MAP

    def problem_with(self, object_name: str) -> str:
        """Return why an object cannot be searched, as a sentence; empty if it can."""
        if not self.furniture:
            return f"{self.source}: has no furniture on which {object_name} could be"
        if object_name not in self.objects:
            choices = hint_or_choices(object_name, self.objects)
            return f"{self.source}: objects do not list {object_name}{choices}"
        return ""

    def probabilities(self, object_name: str) -> Dict[str, float]:
        """Return the probability that an object is on each piece of furniture.

        Raises:
            SettingsError: The map does not list the object, or no furniture.
        """
        problem = self.problem_with(object_name)
        if problem:
            raise SettingsError(problem)
        prior = self.objects[object_name]
        weights = {
            name: prior.on.get(top.kind, 0.0) * prior.in_room.get(self.rooms.get(top.room, ""), 1.0)
            for name, top in self.furniture.items()
        }
        total, count = sum(weights.values()), len(weights)
        if not total > 0.0:  # none of the usual furniture is in this home
            return {name: 1.0 / count for name in weights}
        expected = (1.0 - UNEXPECTED) / total
        return {name: expected * weight + UNEXPECTED / count for name, weight in weights.items()}

    def furniture_at(self, x: float, y: float, within: float = 0.3) -> str:
        """Return the name of the furniture nearest to a point of the map; empty if none is near."""
        tops = self.furniture.values()
        nearest = min(tops, key=lambda top: top.distance_to(x, y), default=None)
        return nearest.name if nearest is not None and nearest.distance_to(x, y) <= within else ""


def load_semantic_map(path) -> SemanticMap:
    """Read a semantic map.

    Raises:
        SettingsError: With file, line and key; all mistakes at once.
    """
    table, errors = read_table(path), ErrorList()
    errors.read(table.allow_only, "rooms", "furniture", "objects")
    rooms = errors.read(_rooms, table) or {}
    known = list(ErrorList().read(table.table, "rooms") or ()) if "rooms" in table else []
    furniture = errors.read(_furniture, table, known) or {}
    objects = errors.read(_objects, table) or {}
    errors.raise_all()
    return SemanticMap(rooms, furniture, objects, str(path))


def _rooms(table: Table) -> Dict[str, str]:
    if "rooms" not in table:
        return {}
    rooms = table.table("rooms")

    def read(name: str) -> Tuple[str, str]:
        entry = rooms.table(name)
        entry.allow_only("kind")
        return name, entry.text("kind")

    return dict(read_each(read, rooms))


def _furniture(table: Table, rooms) -> Dict[str, FurnitureTop]:
    if "furniture" not in table:
        return {}
    entries = table.table("furniture")

    def read(name: str) -> FurnitureTop:
        entry = entries.table(name)
        entry.allow_only("kind", "room", "x", "y", "yaw", "size", "height")
        room = entry.text("room") if "room" in entry else ""
        if room and room not in rooms:
            raise entry.error_at("room", f"names no room: {room}{hint_or_choices(room, rooms)}")
        width, depth = entry.numbers("size", "width, depth")
        entry.check(min(width, depth) > 0.0 and max(width, depth) <= 100.0, "size", "from 0 to 100 m")
        height = entry.number("height")
        entry.check(0.0 <= height <= 10.0, "height", "from 0 to 10 m")
        pose = Pose2(entry.number("x"), entry.number("y"), entry.number("yaw", 0.0))
        entry.check(pose.is_in_range(), "x", "a coordinate in the map")
        return FurnitureTop(name, entry.text("kind"), room, pose, (width, depth), height)

    return {top.name: top for top in read_each(read, entries)}


def _objects(table: Table) -> Dict[str, ObjectPrior]:
    if "objects" not in table:
        return {}
    entries = table.table("objects")

    def read(name: str) -> ObjectPrior:
        entry = entries.table(name)
        entry.allow_only("on", "in")
        factors = _weights(entry, "in") if "in" in entry else {}
        return ObjectPrior(name, _weights(entry, "on"), factors)

    return {prior.name: prior for prior in read_each(read, entries)}


def _weights(entry: Table, key: str) -> Dict[str, float]:
    weights = entry.table(key)
    values = {name: weights.number(name) for name in weights}
    for name, value in values.items():
        weights.check(0.0 <= value <= 1e6, name, "a weight from 0 to 1000000")
    return values


@dataclass(frozen=True)
class PlacedObject:
    """Where an object truly is.

    Attributes:
        name: Name of the object.
        x: Position in the map [m].
        y: Position in the map [m].
        z: Height above the floor [m].
    """

    name: str
    x: float
    y: float
    z: float

    @property
    def pose(self) -> Pose2:
        """Position as a pose in the map."""
        return Pose2(self.x, self.y)


def load_objects(path) -> Tuple[PlacedObject, ...]:
    """Read where objects truly are: ``cup: {on: table in kitchen}`` or ``cup: {x: 1.0, y: 2.0, z: 0.8}``.

    Furniture is that of the semantic map in the same folder.

    Raises:
        SettingsError: With file, line and key.
    """
    table = read_table(path)
    folder = Path(path).parent
    needs_map = any("on" in table.table(name) for name in table)
    tops = load_semantic_map(folder / SEMANTIC_MAP).furniture if needs_map else {}
    return tuple(read_each(lambda name: _placed(table.table(name), name, tops), table))


def _placed(entry: Table, name: str, tops: Mapping[str, FurnitureTop]) -> PlacedObject:
    if "on" not in entry:
        entry.allow_only("x", "y", "z")
        return PlacedObject(name, entry.number("x"), entry.number("y"), entry.number("z", 0.8))
    entry.allow_only("on")
    on = entry.text("on")
    if on not in tops:
        raise entry.error_at("on", f"names no furniture of {SEMANTIC_MAP}: {on}{hint_or_choices(on, tops)}")
    top = tops[on]
    return PlacedObject(name, top.pose.x, top.pose.y, min(top.height, SHELF_HEIGHT))
