"""Zones that people draw into a map: where the robot must not go, and where it must go slowly."""

import math
from dataclasses import dataclass, field
from typing import List, Sequence, Tuple

import numpy as np

from move_base_lite.costmap import Polygon
from planar import Pose2
from planar.config.yaml_table import Table, read_table

KEEP_OUT, SPEED = "keep_out", "speed"


@dataclass(frozen=True)
class NavigationZone:
    """A polygon ``corners`` (at least 3, metres, in the map) with a meaning.

    ``kind``: ``keep_out``, or ``speed``, in which the robot drives no faster than ``max_speed``, m/s.
    ``enabled``: whether it counts from the start.
    """

    name: str
    kind: str
    corners: Tuple[Tuple[float, float], ...] = field(repr=False)
    max_speed: float = math.inf
    enabled: bool = True

    @property
    def polygon(self) -> Polygon:
        return Polygon(np.array(self.corners))

    def contains(self, x: float, y: float) -> bool:
        """Whether a point of the map lies in the polygon (even-odd rule)."""
        return self.polygon.contains(x, y)


class Zones:
    """All zones, each on or off."""

    def __init__(self, zones: Sequence[NavigationZone] = ()):
        self.all = tuple(zones)
        self._enabled = {zone.name for zone in zones if zone.enabled}

    def is_enabled(self, name: str) -> bool:
        return name in self._enabled

    def enable(self, name: str, is_on: bool) -> None:
        """Switches the zone of that name on or off."""
        (self._enabled.add if is_on else self._enabled.discard)(name)

    def keep_out_of(self, base_in_map: Pose2) -> Tuple[List[NavigationZone], List[NavigationZone]]:
        """The keep-out zones that bar the robot's way, and those it stands in and has to get out of."""
        counting = self._counting(KEEP_OUT)
        inside = [zone for zone in counting if zone.contains(base_in_map.x, base_in_map.y)]
        return [zone for zone in counting if zone not in inside], inside

    def keep_out_at(self, x: float, y: float) -> List[NavigationZone]:
        """The keep-out zones that hold a point of the map."""
        return [zone for zone in self._counting(KEEP_OUT) if zone.contains(x, y)]

    def max_speed(self, base_in_map: Pose2) -> float:
        """The highest speed allowed where the robot is, m/s; inf if any is."""
        here = (zone for zone in self._counting(SPEED) if zone.contains(base_in_map.x, base_in_map.y))
        return min((zone.max_speed for zone in here), default=math.inf)

    def _counting(self, kind: str) -> List[NavigationZone]:
        return [zone for zone in self.all if zone.kind == kind and zone.name in self._enabled]


def load_zones(path) -> Zones:
    """Zones of a YAML file ``name: {kind: keep_out, corners: [[x, y], ...]}``; a zone that is not to count
    from the start has ``enabled: false``, and one of kind ``speed`` its ``max_speed``, m/s.

    Raises SettingsError naming file, line and key.
    """
    table = read_table(path)
    return Zones([_zone(name, table.table(name)) for name in table])


def _zone(name: str, table: Table) -> NavigationZone:
    kind = table.choice("kind", (KEEP_OUT, SPEED))
    table.allow_only("kind", "corners", "enabled", *(["max_speed"] if kind == SPEED else []))
    max_speed = table.number("max_speed") if kind == SPEED else math.inf
    if max_speed <= 0.0:
        raise table.complaint("max_speed", f"must be positive, got {max_speed:g}")
    return NavigationZone(name, kind, _corners(table), max_speed, table.flag("enabled", True))


def _corners(table: Table) -> Tuple[Tuple[float, float], ...]:
    value = table.value("corners")
    try:
        corners = tuple((float(x), float(y)) for x, y in value)
    except (TypeError, ValueError, OverflowError):
        corners = ()
    if len(corners) < 3 or not np.isfinite(corners).all():
        raise table.complaint("corners", f"must be at least 3 points [x, y], got {value!r}")
    return corners
