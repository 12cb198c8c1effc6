"""Doors that close during a run; the map shows all of them open."""

import math
from dataclasses import replace
from typing import List, Sequence, Tuple, Union

import numpy as np

from laboratory.tasks.shortest_paths import PASSAGE_CLEARANCE, connected_regions
from laboratory.worlds.source import Arena
from planar import OCCUPIED, OccupancyGrid, Pose2, SettingsError
from planar.config.error_list import read_each
from planar.config.yaml_table import Table
from planar.maps.places import parse_pose
from sim_bridge.doorway import Door

# Range of the closing time [simulated s].
CLOSING_TIMES = (5.0, 60.0)
_STREAM = 49


def with_doors(arena: Arena, max_count: int, seed: int, places: Sequence[Pose2]) -> Arena:
    """Close doorways at random times until the end of the run.

    Args:
        arena: Arena with a map and doorways.
        max_count: Number of doors; fewer are closed if more would separate the places.
        seed: Seed of the choice.
        places: Poses that stay connected.

    Raises:
        SettingsError: The arena has no known doorways.
    """
    if arena.grid is None or not arena.doorways:
        raise SettingsError(f"{arena.title}: doors need a generated building or a list of poses")
    rng = np.random.default_rng([seed, _STREAM])
    grid = arena.grid
    doors: List[Door] = []
    for number in rng.permutation(len(arena.doorways)):
        if len(doors) == max_count:
            break
        door, start = arena.doorways[number], round(float(rng.uniform(*CLOSING_TIMES)), 1)
        closed_grid = _with_closed(grid, door)
        if _are_connected(closed_grid, places):
            grid = closed_grid
            doors.append(replace(door, start=start))
    return with_doors_at(arena, doors)


def with_doors_at(arena: Arena, doors: Sequence[Door]) -> Arena:
    """Add these doors."""
    return replace(arena, world=replace(arena.world, doors=(*arena.world.doors, *doors)))


def _with_closed(grid: OccupancyGrid, door: Door) -> OccupancyGrid:
    along = np.arange(-door.width / 2.0, door.width / 2.0, grid.resolution / 2.0)
    across = np.array((-math.sin(door.pose.yaw), math.cos(door.pose.yaw)))
    rows, cols = grid.cells_of((door.pose.x, door.pose.y) + along[:, None] * across).T
    cells = grid.cells.copy()
    cells[rows, cols] = OCCUPIED
    return replace(grid, cells=cells)


def _are_connected(grid: OccupancyGrid, places: Sequence[Pose2]) -> bool:
    """Whether the poses are connected for a robot."""
    rows, cols = grid.cells_of([(place.x, place.y) for place in places]).T
    found = set(connected_regions(grid, PASSAGE_CLEARANCE)[rows, cols].tolist())
    return len(found) == 1 and found != {0}


def read_doors(happens: Table) -> Union[int, Tuple[Door, ...]]:
    """Read ``doors``: their number, or a list of doors with pose and times. Raises SettingsError."""
    if "doors" not in happens:
        return 0
    if not isinstance(happens.value("doors"), list):
        return happens.count("doors")
    tables = enumerate(happens.tables("doors"))
    return read_each(lambda entry: _read_door(f"door_{entry[0]}", entry[1]), tables)


def _read_door(name: str, table: Table) -> Door:
    table.allow_only("x", "y", "yaw", "width", "start", "end")
    width, start = table.number("width"), table.number("start", Door.start)
    table.check(0.0 < width <= 10.0, "width", "positive and at most 10 m")
    table.check(start >= 0.0, "start", "not negative")
    end = table.number("end") if "end" in table else Door.end
    table.check(end > start, "end", f"after start ({start:g})")
    return Door(name, parse_pose(table), width, start, end)
