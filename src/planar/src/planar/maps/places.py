"""Named places of a map, from YAML: where errands lead."""

from dataclasses import dataclass
from typing import Dict, Optional, Tuple

from planar.config.yaml_table import Table, read_table
from planar.errors import SettingsError
from planar.geometry.grid import OCCUPIED, UNKNOWN, OccupancyGrid
from planar.geometry.pose import Pose2

DEFAULT_RADIUS = 0.35


@dataclass(frozen=True)
class NamedPlace:
    """A named pose in the map, and others that serve as well; within ``radius`` metres a robot is there.

    ``approaches``: the other poses, in the order in which they are worth trying.
    """

    name: str
    pose: Pose2
    radius: float = DEFAULT_RADIUS
    approaches: Tuple[Pose2, ...] = ()

    @property
    def poses(self) -> Tuple[Pose2, ...]:
        return (self.pose, *self.approaches)

    def distance_to(self, robot_in_map: Pose2) -> float:
        """Metres to the nearest of its poses."""
        return min(pose.distance_to(robot_in_map) for pose in self.poses)

    def contains(self, robot_in_map: Pose2) -> bool:
        return self.distance_to(robot_in_map) <= self.radius


def load_places(path) -> Dict[str, NamedPlace]:
    """The places of a YAML file ``name: {x: 1.0, y: 2.0, yaw: 0.0, radius: 0.35}`` by name.

    ``yaw`` and ``radius`` may be left out; ``approaches: [{x: 1.0, y: 1.5, yaw: 1.57}]`` may be added.
    Raises SettingsError naming file, line and key.
    """
    table = read_table(path)
    return {name: parse_place(table, name) for name in table}


def parse_place(table: Table, name: str) -> NamedPlace:
    """The place below the key ``name`` of a table."""
    fields = table.table(name)
    fields.allow_only("x", "y", "yaw", "radius", "approaches")
    approaches = fields.tables("approaches")
    for approach in approaches:
        approach.allow_only("x", "y", "yaw")
    radius = fields.number("radius", DEFAULT_RADIUS)
    fields.check(radius > 0.0, "radius", "positive")
    return NamedPlace(name, parse_pose(fields), radius, tuple(map(parse_pose, approaches)))


def parse_pose(table: Table) -> Pose2:
    """The pose of a table's keys ``x``, ``y`` and, if it is there, ``yaw``."""
    return Pose2(table.number("x"), table.number("y"), table.number("yaw", 0.0))


def load_pickup_and_dropoff(path) -> Tuple[NamedPlace, NamedPlace]:
    """The places ``pickup`` and ``dropoff`` of a YAML file. Raises SettingsError."""
    places = load_places(path)
    for name in ("pickup", "dropoff"):
        if name not in places:
            raise SettingsError(f"{path}: place {name} is missing")
    return places["pickup"], places["dropoff"]


def unreachable_reason(place: NamedPlace, grid: OccupancyGrid) -> Optional[str]:
    """Why no robot can ever stand at a pose of ``place`` on this map, or None if all seem free."""
    for pose in place.poses:
        obstruction = obstruction_at(pose, grid)
        if obstruction:
            return f"place {place.name} ({pose.x:g}, {pose.y:g}) {obstruction}"
    return None


def obstruction_at(pose: Pose2, grid: OccupancyGrid) -> Optional[str]:
    """Why no robot can ever stand there on this map, or None if it seems free."""
    cell = grid.cells_of([[pose.x, pose.y]])
    if not grid.contains(cell)[0]:
        return "lies outside the map"
    value = grid.cells[tuple(cell[0])]
    if value == UNKNOWN:
        return "lies where the map knows nothing"
    return "lies in an obstacle of the map" if value == OCCUPIED else None
