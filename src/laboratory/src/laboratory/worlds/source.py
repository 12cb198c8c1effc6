"""The contract of a source of worlds.

A source is a frozen dataclass of its own file, with a function that reads it from a scenario's table
``world``, and one line of the registry. The same seed gives the same world.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Protocol, Tuple

from planar import OccupancyGrid
from planar.deprecation import renamed_fields
from planar.maps.places import NamedPlace
from sim_bridge.doorway import Door
from sim_bridge.world import World


@renamed_fields(way="reference_length")
@dataclass(frozen=True, eq=False)
class Arena:
    """A world, and what is known of it.

    ``grid``: the map that the robot is given; None: it has none. ``title``: which of several worlds it is.
    ``way``: metres of the way that a benchmark compares with. ``places``: within reach in it.
    ``doorways``: doors that may be shut, if it is known where they are.
    """

    world: World
    grid: Optional[OccupancyGrid] = None
    title: str = ""
    reference_length: Optional[float] = None
    places: Tuple[NamedPlace, ...] = ()
    doorways: Tuple[Door, ...] = ()


class WorldSource(Protocol):
    """Gives a world for each seed."""

    def arena(self, seed: int) -> Arena:
        """Raises PlanarError naming what is wrong."""

    def files(self) -> Tuple[Path, ...]:
        """What the worlds are made from."""

    def arena_number(self, seed: int) -> int:
        """The same for seeds of the same world."""
