"""Generated buildings: what homes, offices and halls have in common. All their places are reachable."""

import math
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Callable, ClassVar, Sequence, Tuple, Type

import numpy as np

from laboratory.generators.floor_plan import Rectangle, WallSegment
from laboratory.generators.furniture import STANDING_CLEARANCE
from laboratory.tasks.shortest_paths import PASSAGE_CLEARANCE, connected_regions
from laboratory.worlds.solids import FLOOR, wall
from laboratory.worlds.source import Arena, GeneratedWorlds
from planar import FREE, OccupancyGrid, Pose2, SettingsError
from planar.config.yaml_table import Table
from planar.geometry.distance_field import distance_field
from planar.maps.places import NamedPlace
from sim_bridge.doorway import Door
from sim_bridge.views.true_map import true_map
from sim_bridge.world import Body, World

# Minimum distance between two places [m]; number of places in a building.
PLACE_SPACING, PLACE_COUNT = 1.5, 5


@dataclass(frozen=True)
class BuildingLayout:
    """Layout of a building [m].

    Attributes:
        walls: Rectangles of the walls.
        furniture: Rectangles of the furniture.
        start: Start position of the robot, which becomes the origin of the world.
        doorways: Gaps in the walls.
    """

    walls: Sequence[Rectangle]
    furniture: Sequence[Rectangle]
    start: Tuple[float, float]
    doorways: Sequence[WallSegment] = ()


@dataclass(frozen=True)
class BuildingGenerator(GeneratedWorlds):
    """World source with a different building for each seed; the robot starts at the origin.

    Subclasses define the class attributes and ``layout``.

    Attributes:
        kind: Name of the kind of building.
        stream: Number of its stream of random numbers.
        areas: Smallest and largest area it supports [m2].
        min_area: Smallest area to generate [m2].
        max_area: Largest area to generate [m2].
    """

    kind: ClassVar[str]
    stream: ClassVar[int]
    areas: ClassVar[Tuple[float, float]]
    min_area: float
    max_area: float

    def layout(self, area: float, rng: np.random.Generator) -> BuildingLayout:
        """Generate a building of this area [m2]."""
        raise NotImplementedError

    def arena(self, seed: int) -> Arena:
        return _arena(self, seed)


@lru_cache(maxsize=4)
def _arena(source: BuildingGenerator, seed: int) -> Arena:
    rng = np.random.default_rng([seed, source.stream])
    area = math.exp(rng.uniform(math.log(source.min_area), math.log(source.max_area)))
    layout = source.layout(area, rng)
    bodies = [_solid_body(f"wall_{number}", solid, layout.start) for number, solid in enumerate(layout.walls)]
    bodies += [
        _solid_body(f"furniture_{number}", piece, layout.start)
        for number, piece in enumerate(layout.furniture)
    ]
    world = World(f"{source.kind}_{seed}", (FLOOR, *bodies))
    grid = true_map(world)
    places = _places(grid, rng)
    if len(places) < 2:
        raise SettingsError(f"the generated {source.kind} has fewer than two places where a robot can stand")
    doorways = [_door(f"door_{number}", gap, layout.start) for number, gap in enumerate(layout.doorways)]
    return Arena(world, grid, f"{source.kind} of {area:.0f} m2", None, places, tuple(doorways))


def _solid_body(name: str, solid: Rectangle, origin: Tuple[float, float]) -> Body:
    x, y = solid.middle
    return wall(name, x - origin[0], y - origin[1], solid.width, solid.depth)


def _door(name: str, gap: WallSegment, origin: Tuple[float, float]) -> Door:
    """The door that fills a doorway."""
    x, y = (gap.x1 + gap.x2) / 2.0 - origin[0], (gap.y1 + gap.y2) / 2.0 - origin[1]
    yaw = 0.0 if gap.x1 == gap.x2 else math.pi / 2.0
    return Door(name, Pose2(x, y, yaw), gap.length)


def _places(grid: OccupancyGrid, rng: np.random.Generator) -> Tuple[NamedPlace, ...]:
    """Random places for deliveries, all reachable from the origin."""
    connected = connected_regions(grid, PASSAGE_CLEARANCE)
    ((row, col),) = grid.cells_of([[0.0, 0.0]])
    has_clearance = distance_field(grid.cells != FREE, grid.resolution) > STANDING_CLEARANCE
    free_xy = grid.points_of(np.argwhere((connected == connected[row, col]) & has_clearance))
    places: Tuple[NamedPlace, ...] = ()
    while len(places) < PLACE_COUNT and len(free_xy):
        x, y = free_xy[rng.integers(len(free_xy))].tolist()
        yaw = float(rng.uniform(-math.pi, math.pi))
        places = (*places, NamedPlace(f"place {len(places)}", Pose2(x, y, yaw)))
        free_xy = free_xy[np.hypot(*(free_xy - (x, y)).T) > PLACE_SPACING]
    return places


def area_reader(key: str, buildings: Type[BuildingGenerator]) -> Callable[[Table, Path], BuildingGenerator]:
    """Make the reader of the table ``key``, whose optional ``area`` is [smallest, largest] in m2."""

    def read(table: Table, folder: Path) -> BuildingGenerator:
        table.allow_only(key)
        part = table.table(key)
        part.allow_only("area")
        smallest, largest = buildings.areas
        if "area" not in part:
            return buildings(smallest, largest)
        area = part.numbers("area", "smallest, largest")
        is_fine = smallest <= area[0] <= area[1] <= largest
        part.check(is_fine, "area", f"within {smallest:g} to {largest:g} m2, the smaller first")
        return buildings(*area)

    return read
