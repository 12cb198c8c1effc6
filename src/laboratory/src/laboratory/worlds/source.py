"""Contract of a world source.

A world source is a frozen dataclass in a module of this folder, with a function that reads it from the table
``world`` of a scenario and an entry in laboratory.scenario.registry. The same seed gives the same world.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Protocol, Tuple

from planar import OccupancyGrid, Pose2
from planar.deprecation import renamed_fields
from planar.maps.places import NamedPlace
from sim_bridge.doorway import Door
from sim_bridge.world import World


@renamed_fields(way="reference_length")
@dataclass(frozen=True, eq=False)
class Arena:
    """A world with its map and places.

    Attributes:
        world: The simulated world.
        grid: Map that the robot is given; None: it has none.
        title: Name of the world in results.
        reference_length: Length of the benchmark's reference path [m].
        places: Named poses, all reachable from the start.
        doorways: Doors that may be closed.
        start: A free pose, from which the contract checks measure scans; tasks start at the scenario's.
    """

    world: World
    grid: Optional[OccupancyGrid] = None
    title: str = ""
    reference_length: Optional[float] = None
    places: Tuple[NamedPlace, ...] = ()
    doorways: Tuple[Door, ...] = ()
    start: Pose2 = Pose2()


class WorldSource(Protocol):
    """A world for each seed."""

    def arena(self, seed: int) -> Arena:
        """Return the world of a seed. Raises PlanarError."""

    def files(self) -> Tuple[Path, ...]:
        """Return the files the worlds are read from."""

    def arena_number(self, seed: int) -> int:
        """Return a number that is equal for seeds with the same world."""


class GeneratedWorlds:
    """Base of the sources that generate another world from each seed."""

    def files(self) -> Tuple[Path, ...]:
        return ()

    def arena_number(self, seed: int) -> int:
        return seed
