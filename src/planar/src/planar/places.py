"""Named places of a map, from YAML: where errands lead."""

from dataclasses import dataclass
from typing import Dict, Optional, Tuple

from planar.errors import SettingsError
from planar.grid import OCCUPIED, UNKNOWN, OccupancyGrid
from planar.pose import Pose2
from planar.yaml_table import Table, read_table

DEFAULT_RADIUS = 0.35


@dataclass(frozen=True)
class Place:
    """A named pose in the map; a robot within ``radius`` metres of it is there."""

    name: str
    pose: Pose2
    radius: float = DEFAULT_RADIUS

    def holds(self, robot_in_map: Pose2) -> bool:
        return self.pose.distance_to(robot_in_map) <= self.radius


def load_places(path) -> Dict[str, Place]:
    """The places of a YAML file ``name: {x: 1.0, y: 2.0, yaw: 0.0, radius: 0.35}`` by name.

    ``yaw`` and ``radius`` may be left out. Raises SettingsError naming file, line and key.
    """
    table = read_table(path)
    return {name: place_from(table, name) for name in table}


def place_from(table: Table, name: str) -> Place:
    """The place below the key ``name`` of a table."""
    fields = table.table(name)
    fields.allow_only("x", "y", "yaw", "radius")
    place = Place(name, pose_from(fields), fields.number("radius", DEFAULT_RADIUS))
    fields.check(place.radius > 0.0, "radius", "positive")
    return place


def pose_from(table: Table) -> Pose2:
    """The pose of a table's keys ``x``, ``y`` and, if it is there, ``yaw``."""
    return Pose2(table.number("x"), table.number("y"), table.number("yaw", 0.0))


def places_of_errand(path) -> Tuple[Place, Place]:
    """The places ``pickup`` and ``dropoff`` of a YAML file. Raises SettingsError."""
    places = load_places(path)
    for name in ("pickup", "dropoff"):
        if name not in places:
            raise SettingsError(f"{path}: place {name} is missing")
    return places["pickup"], places["dropoff"]


def why_unreachable(place: Place, grid: OccupancyGrid) -> Optional[str]:
    """Why no robot can ever stand at ``place`` on this map, or None if it seems free."""
    where = f"place {place.name} ({place.pose.x:g}, {place.pose.y:g})"
    cell = grid.cells_of([[place.pose.x, place.pose.y]])
    if not grid.contains(cell)[0]:
        return f"{where} lies outside the map"
    value = grid.cells[tuple(cell[0])]
    if value == UNKNOWN:
        return f"{where} lies where the map knows nothing"
    return f"{where} lies in an obstacle of the map" if value == OCCUPIED else None
