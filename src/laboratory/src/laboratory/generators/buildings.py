"""Buildings: what homes, offices and halls have in common. Every place in them can be reached."""

import math
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Callable, ClassVar, Sequence, Tuple, Type

import numpy as np

from laboratory.generators.furniture import ROOM_TO_STAND
from laboratory.generators.rooms import Room, Wall
from laboratory.tasks.ways import ROOM_TO_PASS, regions
from laboratory.worlds.solids import FLOOR, wall
from laboratory.worlds.source import Arena
from planar import FREE, OccupancyGrid, Pose2, SettingsError
from planar.config.yaml_table import Table
from planar.geometry.distance_field import distance_field
from planar.maps.places import NamedPlace
from sim_bridge.doorway import Door
from sim_bridge.views.true_map import true_map
from sim_bridge.world import Body, World

# Metres between two places; places a building.
APART, PLACES = 1.5, 5


@dataclass(frozen=True)
class Plan:
    """A drawn building, metres, and where the robot starts in it."""

    walls: Sequence[Room]
    furniture: Sequence[Room]
    start: Tuple[float, float]
    doorways: Sequence[Wall] = ()


@dataclass(frozen=True)
class Buildings:
    """Another one for each seed, of an area between two, square metres; the robot starts at the origin.

    A kind of building is derived from this in a file of its own, says its ``kind``, the ``stream`` of its
    random numbers and which areas it can have, and draws.
    """

    kind: ClassVar[str]
    stream: ClassVar[int]
    areas: ClassVar[Tuple[float, float]]
    least: float
    largest: float

    def draw(self, area: float, rng: np.random.Generator) -> Plan:
        raise NotImplementedError

    def arena(self, seed: int) -> Arena:
        return _arena(self, seed)

    def files(self) -> Tuple[Path, ...]:
        return ()

    def arena_number(self, seed: int) -> int:
        return seed


@lru_cache(maxsize=4)
def _arena(source: Buildings, seed: int) -> Arena:
    rng = np.random.default_rng([seed, source.stream])
    area = math.exp(rng.uniform(math.log(source.least), math.log(source.largest)))
    plan = source.draw(area, rng)
    bodies = [_body(f"wall_{number}", solid, plan.start) for number, solid in enumerate(plan.walls)]
    bodies += [_body(f"furniture_{number}", piece, plan.start) for number, piece in enumerate(plan.furniture)]
    world = World(f"{source.kind}_{seed}", (FLOOR, *bodies))
    grid = true_map(world)
    places = _places(grid, rng)
    if len(places) < 2:
        raise SettingsError(f"the generated {source.kind} has no two places to stand")
    doorways = [_door(f"door_{number}", gap, plan.start) for number, gap in enumerate(plan.doorways)]
    return Arena(world, grid, f"{source.kind} of {area:.0f} m2", None, places, tuple(doorways))


def _body(name: str, solid: Room, origin: Tuple[float, float]) -> Body:
    x, y = solid.middle
    return wall(name, x - origin[0], y - origin[1], solid.width, solid.depth)


def _door(name: str, gap: Wall, origin: Tuple[float, float]) -> Door:
    """What would fill a doorway."""
    x, y = (gap.x1 + gap.x2) / 2.0 - origin[0], (gap.y1 + gap.y2) / 2.0 - origin[1]
    yaw = 0.0 if gap.x1 == gap.x2 else math.pi / 2.0
    return Door(name, Pose2(x, y, yaw), gap.length)


def _places(grid: OccupancyGrid, rng: np.random.Generator) -> Tuple[NamedPlace, ...]:
    """Where things are fetched and brought, apart from each other, all within reach of the origin."""
    reach = regions(grid, ROOM_TO_PASS)
    ((row, col),) = grid.cells_of([[0.0, 0.0]])
    roomy = distance_field(grid.cells != FREE, grid.resolution) > ROOM_TO_STAND
    spots_xy = grid.points_of(np.argwhere((reach == reach[row, col]) & roomy))
    places: Tuple[NamedPlace, ...] = ()
    while len(places) < PLACES and len(spots_xy):
        x, y = spots_xy[rng.integers(len(spots_xy))].tolist()
        yaw = float(rng.uniform(-math.pi, math.pi))
        places = (*places, NamedPlace(f"place {len(places)}", Pose2(x, y, yaw)))
        spots_xy = spots_xy[np.hypot(*(spots_xy - (x, y)).T) > APART]
    return places


def reader_of(key: str, buildings: Type[Buildings]) -> Callable[[Table, Path], Buildings]:
    """Reads them from ``key``: the area, from least to largest, if it is told."""

    def read(table: Table, folder: Path) -> Buildings:
        table.allow_only(key)
        part = table.table(key)
        part.allow_only("area")
        smallest, largest = buildings.areas
        if "area" not in part:
            return buildings(smallest, largest)
        area = part.numbers("area", "least, largest")
        is_fine = smallest <= area[0] <= area[1] <= largest
        part.check(is_fine, "area", f"within {smallest:g} to {largest:g} m2, the least first")
        return buildings(*area)

    return read
