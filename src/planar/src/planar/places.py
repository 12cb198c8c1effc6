"""Named places of a map, from YAML: where errands lead."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, Optional, Tuple

import yaml

from planar.errors import SettingsError
from planar.grid import OCCUPIED, UNKNOWN, OccupancyGrid
from planar.pose import Pose2

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

    ``yaw`` and ``radius`` may be left out. Raises SettingsError naming file, place and key.
    """
    path = Path(path)
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise SettingsError(f"{path}: no such file of places") from None
    except (OSError, UnicodeDecodeError) as error:
        raise SettingsError(f"{path}: cannot be read ({error})") from None
    except yaml.YAMLError as error:
        raise SettingsError(f"{path}: not valid YAML ({' '.join(str(error).split())})") from None
    if not isinstance(content, dict):
        raise SettingsError(f"{path}: expected named places, e.g. pickup: {{x: 2.0, y: 3.0, yaw: 0.0}}")
    return {str(name): _place(path, str(name), fields) for name, fields in content.items()}


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


def _place(path: Path, name: str, fields: Any) -> Place:
    if not isinstance(fields, dict):
        raise SettingsError(f"{path}: place {name} must have keys x and y, got {fields!r}")
    unknown = set(fields) - {"x", "y", "yaw", "radius"}
    if unknown:
        raise SettingsError(f"{path}: place {name} has an unknown key {sorted(map(str, unknown))[0]}")
    x, y = _number(path, name, fields, "x"), _number(path, name, fields, "y")
    yaw = _number(path, name, fields, "yaw", 0.0)
    radius = _number(path, name, fields, "radius", DEFAULT_RADIUS)
    if radius <= 0.0:
        raise SettingsError(f"{path}: place {name}: radius must be positive, got {radius}")
    return Place(name, Pose2(x, y, yaw), radius)


def _number(path: Path, name: str, fields: dict, key: str, default: Optional[float] = None) -> float:
    value = fields.get(key, default)
    if value is None:
        raise SettingsError(f"{path}: place {name}: {key} is missing")
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise SettingsError(f"{path}: place {name}: {key} must be a number, got {value!r}")
    return float(value)
