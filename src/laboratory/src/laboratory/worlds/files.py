"""A world of files: SDF and the map of it."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Optional, Tuple

from laboratory.worlds.source import Arena
from planar import load_map
from planar.config.yaml_table import Table, read_table
from sim_bridge import load_world


@dataclass(frozen=True)
class WorldFile:
    """The same world for all seeds."""

    world: Path
    map: Optional[Path] = None

    def arena(self, seed: int) -> Arena:
        return _arena(self)

    def files(self) -> Tuple[Path, ...]:
        if self.map is None:
            return (self.world,)
        return (self.world, self.map, self.map.parent / read_table(self.map).text("image"))

    def arena_number(self, seed: int) -> int:
        return 0


@lru_cache(maxsize=4)
def _arena(source: WorldFile) -> Arena:
    grid = None if source.map is None else load_map(source.map)
    return Arena(load_world(source.world), grid, source.world.stem)


def read_world_file(table: Table, folder: Path) -> WorldFile:
    """``file`` and, if the robot has one, ``map``, both beside the scenario."""
    table.allow_only("file", "map")
    known_map = table.path("map", folder) if "map" in table else None
    return WorldFile(table.path("file", folder), known_map)
