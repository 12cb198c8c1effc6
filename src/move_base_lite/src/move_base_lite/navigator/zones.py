"""Keep-out zones and speed zones in the map (Nav2: KeepoutFilter, SpeedFilter)."""

import math
from dataclasses import dataclass, field
from typing import List, Optional, Sequence, Tuple

import numpy as np

from move_base_lite.costmap import Polygon
from planar import Pose2
from planar.config.yaml_table import Table, read_table

KEEP_OUT, SPEED = "keep_out", "speed"
# Name of the zone of a dock, and the housing of a Kobuki's in its frame, with a margin for the error of
# localization except at the front: least and greatest x, half width [m].
DOCK = "dock"
DOCK_HOUSING = -0.12, 0.0, 0.16


@dataclass(frozen=True)
class NavigationZone:
    """A polygon in the map with a rule for the robot.

    Attributes:
        name: Name of the zone, also of its service ~zones/<name>.
        kind: ``keep_out`` or ``speed``.
        corners: At least 3 points (x, y) in the map [m].
        max_speed: Highest speed in a speed zone [m/s].
        enabled: Whether the zone is on at start-up.
    """

    name: str
    kind: str
    corners: Tuple[Tuple[float, float], ...] = field(repr=False)
    max_speed: float = math.inf
    enabled: bool = True

    @property
    def polygon(self) -> Polygon:
        """Polygon of the corners, in the map frame."""
        return Polygon(np.array(self.corners))

    def contains(self, x: float, y: float) -> bool:
        """Check whether a point lies in the polygon (even-odd rule).

        Args:
            x: Position in the map frame [m].
            y: Position in the map frame [m].
        """
        return self.polygon.contains(x, y)


class Zones:
    """All zones, each of which can be switched on and off.

    Attributes:
        all: All zones, whether they are on or off.
    """

    def __init__(self, zones: Sequence[NavigationZone] = ()):
        self.all = tuple(zones)
        self._enabled = {zone.name for zone in zones if zone.enabled}

    def with_dock(self, dock: Optional[Pose2]) -> "Zones":
        """Return these zones and the housing of a dock, which is too low for most lasers.

        Args:
            dock: Pose of the dock's front in the map; x points away from it. None: no dock. A zone of that
                name replaces the housing.
        """
        if dock is None or any(zone.name == DOCK for zone in self.all):
            return self
        back, front, side = DOCK_HOUSING
        outline = (back, -side), (front, -side), (front, side), (back, side)
        corners = tuple((pose.x, pose.y) for pose in (dock @ Pose2(x, y) for x, y in outline))
        return Zones([*self.all, NavigationZone(DOCK, KEEP_OUT, corners)])

    def is_enabled(self, name: str) -> bool:
        """Check whether a zone is on."""
        return name in self._enabled

    def enable(self, name: str, is_on: bool) -> None:
        """Switch a zone on or off.

        Args:
            name: Name of the zone.
            is_on: Whether it is on from now.
        """
        (self._enabled.add if is_on else self._enabled.discard)(name)

    def split_keep_out(self, base_in_map: Pose2) -> Tuple[List[NavigationZone], List[NavigationZone]]:
        """Split the active keep-out zones by whether the robot is inside.

        Args:
            base_in_map: Robot pose in the map frame.

        Returns:
            Zones that block the robot, and zones that it is in and has to leave.
        """
        active = self._active(KEEP_OUT)
        inside = [zone for zone in active if zone.contains(base_in_map.x, base_in_map.y)]
        return [zone for zone in active if zone not in inside], inside

    def keep_out_at(self, x: float, y: float) -> List[NavigationZone]:
        """Return the active keep-out zones that contain a point.

        Args:
            x: Position in the map frame [m].
            y: Position in the map frame [m].
        """
        return [zone for zone in self._active(KEEP_OUT) if zone.contains(x, y)]

    def max_speed(self, base_in_map: Pose2) -> float:
        """Return the highest speed allowed at the robot's position [m/s]; inf outside of speed zones.

        Args:
            base_in_map: Robot pose in the map frame.
        """
        here = (zone for zone in self._active(SPEED) if zone.contains(base_in_map.x, base_in_map.y))
        return min((zone.max_speed for zone in here), default=math.inf)

    def _active(self, kind: str) -> List[NavigationZone]:
        return [zone for zone in self.all if zone.kind == kind and zone.name in self._enabled]


def load_zones(path) -> Zones:
    """Read zones from a YAML file.

    An entry is ``name: {kind: keep_out, corners: [[x, y], ...]}``. A zone that is off at start-up has
    ``enabled: false``; one of kind ``speed`` has ``max_speed`` [m/s].

    Args:
        path: YAML file.

    Raises:
        SettingsError: The file is invalid; the text states file, line and key.
    """
    table = read_table(path)
    return Zones([_zone(name, table.table(name)) for name in table])


def _zone(name: str, table: Table) -> NavigationZone:
    kind = table.choice("kind", (KEEP_OUT, SPEED))
    table.allow_only("kind", "corners", "enabled", *(["max_speed"] if kind == SPEED else []))
    max_speed = table.number("max_speed") if kind == SPEED else math.inf
    if max_speed <= 0.0:
        raise table.error_at("max_speed", f"must be positive, got {max_speed:g}")
    return NavigationZone(name, kind, _corners(table), max_speed, table.flag("enabled", True))


def _corners(table: Table) -> Tuple[Tuple[float, float], ...]:
    value = table.value("corners")
    try:
        corners = tuple((float(x), float(y)) for x, y in value)
    except (TypeError, ValueError, OverflowError):
        corners = ()
    if len(corners) < 3 or not np.isfinite(corners).all():
        raise table.error_at("corners", f"must be at least 3 points [x, y], got {value!r}")
    return corners
