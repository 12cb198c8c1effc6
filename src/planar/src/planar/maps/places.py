"""Named places of a map, read from YAML."""

from dataclasses import dataclass
from typing import Any, Dict, Iterable, Optional, Tuple

from planar.config.yaml_table import Table, read_table
from planar.errors import SettingsError
from planar.geometry.grid import OCCUPIED, UNKNOWN, OccupancyGrid
from planar.geometry.pose import Pose2

DEFAULT_RADIUS = 0.35


@dataclass(frozen=True)
class NamedPlace:
    """A named goal in the map with alternative poses.

    Attributes:
        name: Name.
        pose: Preferred pose of the robot in the map.
        radius: Distance to one of the poses within which the robot is at the place [m].
        approaches: Alternative poses in the order in which to try them.
    """

    name: str
    pose: Pose2
    radius: float = DEFAULT_RADIUS
    approaches: Tuple[Pose2, ...] = ()

    @property
    def poses(self) -> Tuple[Pose2, ...]:
        """All poses, the preferred one first."""
        return (self.pose, *self.approaches)

    def distance_to(self, robot_in_map: Pose2) -> float:
        """Return the distance from a robot pose to the nearest pose of the place [m]."""
        return min(pose.distance_to(robot_in_map) for pose in self.poses)

    def contains(self, robot_in_map: Pose2) -> bool:
        """Return whether a robot at this pose is at the place."""
        return self.distance_to(robot_in_map) <= self.radius


def load_places(path) -> Dict[str, NamedPlace]:
    """Load the places of a YAML file ``name: {x: 1.0, y: 2.0, yaw: 0.0, radius: 0.35}`` by name.

    ``yaw`` and ``radius`` are optional, as is ``approaches: [{x: 1.0, y: 1.5, yaw: 1.57}]``.

    Raises:
        SettingsError: With file, line and key.
    """
    table = read_table(path)
    return {name: parse_place(table, name) for name in table}


def places_table(places: Iterable[NamedPlace]) -> Dict[str, Any]:
    """Return places as the content of a YAML file that ``load_places`` reads."""
    return {
        place.name: {
            **_pose_table(place.pose),
            "radius": place.radius,
            "approaches": [_pose_table(pose) for pose in place.approaches],
        }
        for place in places
    }


def _pose_table(pose: Pose2) -> Dict[str, float]:
    return {"x": pose.x, "y": pose.y, "yaw": pose.yaw}


def parse_place(table: Table, name: str) -> NamedPlace:
    """Return the place under the key ``name`` of a table."""
    fields = table.table(name)
    fields.allow_only("x", "y", "yaw", "radius", "approaches")
    approaches = fields.tables("approaches")
    for approach in approaches:
        approach.allow_only("x", "y", "yaw")
    radius = fields.number("radius", DEFAULT_RADIUS)
    fields.check(radius > 0.0, "radius", "positive")
    return NamedPlace(name, parse_pose(fields), radius, tuple(map(parse_pose, approaches)))


def parse_pose(table: Table) -> Pose2:
    """Return the pose of a table with the keys ``x``, ``y`` and optionally ``yaw``."""
    return Pose2(table.number("x"), table.number("y"), table.number("yaw", 0.0))


def load_pickup_and_dropoff(path) -> Tuple[NamedPlace, NamedPlace]:
    """Load the places ``pickup`` and ``dropoff`` of a YAML file. Raises SettingsError."""
    places = load_places(path)
    for name in ("pickup", "dropoff"):
        if name not in places:
            raise SettingsError(f"{path}: place {name} is missing")
    return places["pickup"], places["dropoff"]


def unreachable_reason(place: NamedPlace, grid: OccupancyGrid) -> Optional[str]:
    """Return why no robot can stand at a pose of a place on this map; None if all poses are free."""
    for pose in place.poses:
        obstruction = obstruction_at(pose, grid)
        if obstruction:
            return f"place {place.name} ({pose.x:g}, {pose.y:g}) {obstruction}"
    return None


def obstruction_at(pose: Pose2, grid: OccupancyGrid) -> Optional[str]:
    """Return why no robot can stand at a pose on this map; None if it is free."""
    cell = grid.cells_of([[pose.x, pose.y]])
    if not grid.contains(cell)[0]:
        return "lies outside the map"
    value = grid.cells[tuple(cell[0])]
    if value == UNKNOWN:
        return "lies in unknown space of the map"
    return "lies in an obstacle of the map" if value == OCCUPIED else None
