"""Zones that people draw into a map: where the robot must not go, and where it must go slowly."""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, List, Sequence, Tuple

import numpy as np
import yaml

from move_base_lite.costmap import Polygon
from planar import Pose2, SettingsError
from planar.settings import check, settings_from

KEEP_OUT, SPEED = "keep_out", "speed"


@dataclass(frozen=True)
class Zone:
    """A polygon ``corners`` (at least 3, metres, in the map) with a meaning.

    ``kind``: ``keep_out``, or ``speed``, in which the robot drives no faster than ``max_speed``, m/s.
    ``enabled``: whether it counts from the start.
    """

    name: str
    kind: str
    corners: Tuple[Tuple[float, float], ...] = field(repr=False)
    max_speed: float = math.inf
    enabled: bool = True

    def __post_init__(self):
        check(self.kind in (KEEP_OUT, SPEED), "kind", f"{KEEP_OUT} or {SPEED}", self.kind)
        check(len(self.corners) >= 3, "corners", "at least 3 points [x, y]", self.corners)
        check(self.max_speed > 0.0, "max_speed", "positive", self.max_speed)
        is_limited = math.isfinite(self.max_speed)
        check(is_limited == (self.kind == SPEED), "max_speed", "given for a speed zone only", self.max_speed)

    @property
    def polygon(self) -> Polygon:
        return Polygon(np.array(self.corners))

    def holds(self, x: float, y: float) -> bool:
        """Whether a point of the map lies in the polygon (even-odd rule)."""
        return self.polygon.holds(x, y)


class Zones:
    """All zones, each on or off."""

    def __init__(self, zones: Sequence[Zone] = ()):
        self.all = tuple(zones)
        self._enabled = {zone.name for zone in zones if zone.enabled}

    def is_enabled(self, name: str) -> bool:
        return name in self._enabled

    def enable(self, name: str, is_on: bool) -> None:
        """Switches the zone of that name on or off."""
        (self._enabled.add if is_on else self._enabled.discard)(name)

    def keep_out_of(self, base_in_map: Pose2) -> Tuple[List[Zone], List[Zone]]:
        """The keep-out zones that bar the robot's way, and those it stands in and has to get out of."""
        counting = self._counting(KEEP_OUT)
        inside = [zone for zone in counting if zone.holds(base_in_map.x, base_in_map.y)]
        return [zone for zone in counting if zone not in inside], inside

    def keep_out_at(self, x: float, y: float) -> List[Zone]:
        """The keep-out zones that hold a point of the map."""
        return [zone for zone in self._counting(KEEP_OUT) if zone.holds(x, y)]

    def max_speed(self, base_in_map: Pose2) -> float:
        """The highest speed allowed where the robot is, m/s; inf if any is."""
        here = (zone for zone in self._counting(SPEED) if zone.holds(base_in_map.x, base_in_map.y))
        return min((zone.max_speed for zone in here), default=math.inf)

    def _counting(self, kind: str) -> List[Zone]:
        return [zone for zone in self.all if zone.kind == kind and zone.name in self._enabled]


def load_zones(path) -> Zones:
    """Zones of a YAML file: for each name its kind, its corners and, if it is a speed zone, its max_speed.

    Raises SettingsError naming file, zone and key.
    """
    try:
        content = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise SettingsError(f"{path}: no such file of zones") from None
    except (OSError, UnicodeDecodeError) as error:
        raise SettingsError(f"{path}: cannot be read ({error})") from None
    except yaml.YAMLError as error:
        raise SettingsError(f"{path}: not valid YAML ({' '.join(str(error).split())})") from None
    if not isinstance(content, dict):
        raise SettingsError(f"{path}: expected zones by name, e.g. stairs: {{kind: keep_out, corners: ...}}")
    return Zones([_zone(f"{path}: zone {name}: ", str(name), values) for name, values in content.items()])


def _zone(where: str, name: str, values: Any) -> Zone:
    if not isinstance(values, dict) or not {"kind", "corners"} <= set(values):
        raise SettingsError(f"{where}expected a table with kind and corners")
    try:
        corners = tuple((float(x), float(y)) for x, y in values["corners"])
        is_finite = all(math.isfinite(value) for corner in corners for value in corner)
    except (TypeError, ValueError):
        is_finite = False
    if not is_finite:
        raise SettingsError(f"{where}corners must be a list of points [x, y], got {values['corners']!r}")
    zone, unknown = settings_from(Zone, {**values, "name": name, "corners": corners}, where=where)
    if unknown:
        raise SettingsError(f"{where}unknown key {unknown[0]}")
    return zone
