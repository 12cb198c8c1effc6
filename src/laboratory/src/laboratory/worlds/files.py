"""Worlds read from files."""

import re
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Dict, Optional, Tuple

from laboratory.worlds.source import Arena
from planar import load_map
from planar.config.yaml_table import Table, read_table
from sim_bridge import load_world

# Levels of subfolders that are searched for numbered files.
SEARCH_DEPTH = 3


@dataclass(frozen=True)
class WorldFile:
    """World source of an SDF file and its map; all seeds have the same world."""

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
    """Read ``file``, an SDF world, and the optional ``map``."""
    table.allow_only("file", "map")
    map_file = table.path("map", folder) if "map" in table else None
    return WorldFile(table.path("file", folder), map_file)


def numbered_files(folder: Path, stem: str, suffix: str) -> Dict[int, Path]:
    """Return files ``<stem>_N<suffix>`` of a folder and its subfolders by N; empty if it cannot be read."""
    name = re.compile(rf"{stem}_([0-9]{{1,9}}){re.escape(suffix)}")
    patterns = ["*/" * depth + f"{stem}_*{suffix}" for depth in range(SEARCH_DEPTH + 1)]
    try:
        found = [file for pattern in patterns for file in sorted(folder.glob(pattern))]
    except (OSError, ValueError):  # not a valid folder name
        return {}
    matches = ((name.fullmatch(file.name), file) for file in found)
    return {int(match[1]): file for match, file in matches if match}
