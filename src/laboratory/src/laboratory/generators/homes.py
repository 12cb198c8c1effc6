"""Homes: rooms with doors and furniture, every place of which can be reached."""

import math
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import List, Tuple

import numpy as np
from scipy.ndimage import label

from laboratory.generators.raster import RESOLUTION, Raster
from laboratory.generators.rooms import THICKNESS, Room, floor_plan
from laboratory.worlds.source import Arena
from planar import FREE, OccupancyGrid, Pose2, SettingsError
from planar.config.yaml_table import Table
from planar.geometry.distance_field import distance_field
from planar.maps.places import Place
from sim_bridge.geometry.shapes import Plane
from sim_bridge.simulation import box_on_floor
from sim_bridge.views.true_map import true_map
from sim_bridge.world import Body, Collision, World

SMALLEST, LARGEST = 30.0, 300.0
# Metres: height of walls and furniture, its least and largest side; from a robot's middle to what is solid
# where it stands, and on all its ways; between two places.
HEIGHT, LEAST_SIDE, LARGEST_SIDE = 1.0, 0.4, 1.8
ROOM_TO_STAND, ROOM_TO_PASS, APART = 0.55, 0.35, 1.5
# One piece of furniture for so many square metres, tried so often; places a home.
AREA_OF_A_PIECE, TRIES, PLACES = 5.0, 4, 5
_STREAM = 42


@dataclass(frozen=True)
class Homes:
    """Another home for each seed, of an area between two, square metres; the robot starts at the origin."""

    least: float = SMALLEST
    largest: float = LARGEST

    def arena(self, seed: int) -> Arena:
        return _arena(self.least, self.largest, seed)

    def files(self) -> Tuple[Path, ...]:
        return ()

    def arena_number(self, seed: int) -> int:
        return seed


@lru_cache(maxsize=4)
def _arena(least: float, largest: float, seed: int) -> Arena:
    rng = np.random.default_rng([seed, _STREAM])
    area = math.exp(rng.uniform(math.log(least), math.log(largest)))
    width = math.sqrt(area * rng.uniform(0.7, 1.4))
    outline = Room(0.0, 0.0, width, area / width)
    rooms, walls = floor_plan(outline, rng)
    solids = [wall.solid for wall in walls]
    start = rooms[int(rng.integers(len(rooms)))].middle
    furniture = _furniture(outline, rooms, solids, start, rng)
    floor = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
    bodies = [_body(f"wall_{number}", solid, start) for number, solid in enumerate(solids)]
    bodies += [_body(f"furniture_{number}", solid, start) for number, solid in enumerate(furniture)]
    world = World(f"home_{seed}", (floor, *bodies))
    grid = true_map(world)
    return Arena(world, grid, f"home of {area:.0f} m2", places=_places(grid, rng))


def _body(name: str, solid: Room, origin: Tuple[float, float]) -> Body:
    x, y = solid.middle
    return box_on_floor(name, (solid.width, solid.depth, HEIGHT), Pose2(x - origin[0], y - origin[1]))


def _furniture(
    outline: Room, rooms: List[Room], walls: List[Room], start: Tuple[float, float], rng: np.random.Generator
) -> List[Room]:
    """Pieces along walls or anywhere, none of which cuts anything off."""
    raster = Raster(outline.width, outline.depth)
    for wall in walls:
        raster.fill(*wall.corners)
    pieces: List[Room] = []
    reach = raster.reach(*start, ROOM_TO_PASS)
    for room in rooms:
        wanted = len(pieces) + int(room.area / AREA_OF_A_PIECE)
        for _ in range(TRIES * int(room.area / AREA_OF_A_PIECE)):
            if len(pieces) == wanted:
                break
            piece = _piece(room, rng)
            if piece.distance_to(*start) < ROOM_TO_STAND + RESOLUTION:
                continue
            tried = raster.copy()
            tried.fill(*piece.corners)
            left = tried.reach(*start, ROOM_TO_PASS)
            # Its own place and what is too near to it are lost; more would be a corner that is cut off.
            lost = (piece.width + 2.0 * ROOM_TO_PASS) * (piece.depth + 2.0 * ROOM_TO_PASS)
            if left > 0.0 and reach - left <= lost:
                pieces.append(piece)
                raster, reach = tried, left
    return pieces


def _piece(room: Room, rng: np.random.Generator) -> Room:
    """Most stand against a wall."""
    sides = [min(length, LARGEST_SIDE) for length in (room.width / 2.0, room.depth / 2.0)]
    width, depth = (float(rng.uniform(LEAST_SIDE, side)) for side in sides)
    gap = THICKNESS / 2.0
    x = float(rng.uniform(room.x + gap, room.x + room.width - width - gap))
    y = float(rng.uniform(room.y + gap, room.y + room.depth - depth - gap))
    kind = rng.random()
    if kind < 0.4:
        y = float(rng.choice([room.y + gap, room.y + room.depth - depth - gap]))
    elif kind < 0.8:
        x = float(rng.choice([room.x + gap, room.x + room.width - width - gap]))
    return Room(x, y, width, depth)


def _regions(grid: OccupancyGrid, radius: float) -> Tuple[np.ndarray, int]:
    """Connected cells that a robot's middle can be in, and the number of those around the origin; 0: none."""
    is_open = distance_field(grid.cells != FREE, grid.resolution) > radius
    regions, _ = label(is_open)
    ((row, col),) = grid.cells_of([[0.0, 0.0]])
    return regions, int(regions[row, col])


def _places(grid: OccupancyGrid, rng: np.random.Generator) -> Tuple[Place, ...]:
    """Where things are fetched and brought, apart from each other, all within reach."""
    regions, here = _regions(grid, ROOM_TO_PASS)
    roomy = distance_field(grid.cells != FREE, grid.resolution) > ROOM_TO_STAND
    spots_xy = grid.points_of(np.argwhere((regions == here) & roomy))
    places: List[Place] = []
    while len(places) < PLACES and len(spots_xy):
        x, y = spots_xy[rng.integers(len(spots_xy))].tolist()
        places.append(Place(f"place {len(places)}", Pose2(x, y, float(rng.uniform(-math.pi, math.pi)))))
        spots_xy = spots_xy[np.hypot(*(spots_xy - (x, y)).T) > APART]
    if len(places) < 2:
        raise SettingsError("the generated home has no two places to stand")
    return tuple(places)


def read_homes(table: Table, folder: Path) -> Homes:
    """``homes``: area, from least to largest."""
    table.allow_only("homes")
    part = table.table("homes")
    part.allow_only("area")
    if "area" not in part:
        return Homes()
    least, largest = part.numbers("area", "least, largest")
    part.check(
        SMALLEST <= least <= largest <= LARGEST,
        "area",
        f"within {SMALLEST:g} to {LARGEST:g} m2, the least first",
    )
    return Homes(least, largest)
