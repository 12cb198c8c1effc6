"""DynaBARN's worlds (Nair et al., "DynaBARN: Benchmarking metric ground navigation ...", 2022)."""

import math
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import List, Tuple

import numpy as np

from laboratory.worlds.files import numbered_files
from laboratory.worlds.solids import FLOOR, post, wall
from laboratory.worlds.source import Arena
from planar import Pose2, SettingsError
from planar.config.yaml_table import Table, read_table
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.world import Body, World


@dataclass(frozen=True)
class DynabarnFolder:
    """World source of a folder with dynabarn_N.yaml; seeds use the worlds in turn."""

    folder: Path

    def files(self) -> Tuple[Path, ...]:
        """Return the files in the order of their numbers. Raises SettingsError without any."""
        numbered = numbered_files(self.folder, "dynabarn", ".yaml")
        if not numbered:
            raise SettingsError(f"{self.folder}: no files dynabarn_N.yaml")
        return tuple(numbered[number] for number in sorted(numbered))

    def arena(self, seed: int) -> Arena:
        return _arena(self.files()[self.arena_number(seed)])

    def arena_number(self, seed: int) -> int:
        return seed % len(self.files())


@lru_cache(maxsize=64)
def _arena(file: Path) -> Arena:
    table = read_table(file)
    start, goal = table.numbers("start", "x, y, yaw"), table.numbers("goal", "x, y")
    walls = [wall(f"wall_{number}", *values) for number, values in enumerate(_rows(table, "walls", 4))]
    bodies: List[Body] = [FLOOR, *walls]
    trajectories = []
    for obstacle in table.tables("obstacles"):
        name, keyframes = obstacle.text("name"), _rows(obstacle, "keyframes", 3)
        body = post(
            name, Pose2(*keyframes[0, 1:]), obstacle.number("radius"), obstacle.number("height"), True
        )
        bodies.append(body)
        trajectories.append(ScriptedTrajectory(body.name, keyframes[:, 0], keyframes[:, 1:]))
    title = f"DynaBARN {file.stem.rpartition('_')[2]}"
    world = World(title, tuple(bodies), trajectories=tuple(trajectories))
    return Arena(world, None, title, math.dist(start[:2], goal))


def _rows(table: Table, key: str, length: int) -> np.ndarray:
    rows = table.value(key)
    try:
        array = np.array(rows, dtype=float).reshape(-1, length)
    except (TypeError, ValueError):
        array = np.empty((0, length))
    if not len(array) or len(array) != len(rows) or not np.isfinite(array).all():
        raise table.error_at(key, f"must be lists of {length} numbers")
    return array


def read_dynabarn(table: Table, folder: Path) -> DynabarnFolder:
    """Read ``dynabarn``: the folder of the worlds."""
    table.allow_only("dynabarn")
    source = DynabarnFolder(table.path("dynabarn", folder))
    try:
        source.files()
    except SettingsError as error:
        raise table.error_at("dynabarn", f"cannot be used: {error}") from None
    return source
