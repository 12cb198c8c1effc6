"""BARN's worlds (Perille et al., "Benchmarking metric ground navigation", 2020)."""

import math
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Tuple

import numpy as np

from laboratory.worlds.files import numbered_files
from laboratory.worlds.source import Arena
from planar import Pose2, SettingsError
from planar.config.yaml_table import Table
from planar.files.reading import read_array
from sim_bridge import load_world

START = Pose2(-2.25, 3.0, math.pi / 2.0)
GOAL_IN_ODOM = Pose2(10.0, 0.0)
# Speed on the reference path that gives the optimal time [m/s].
REFERENCE_SPEED = 2.0


@dataclass(frozen=True)
class BarnFolder:
    """World source of a folder with world_N.world and path_N.npy; seeds use the worlds in turn."""

    folder: Path

    def pairs(self) -> Tuple[Tuple[int, Path, Path], ...]:
        """Return number, world file and reference path of each world. Raises SettingsError without any."""
        worlds = numbered_files(self.folder, "world", ".world")
        paths = numbered_files(self.folder, "path", ".npy")
        both = sorted(set(worlds) & set(paths))
        if not both:
            raise SettingsError(f"{self.folder}: no pairs of world_N.world and path_N.npy")
        return tuple((number, worlds[number], paths[number]) for number in both)

    def arena(self, seed: int) -> Arena:
        number, world, path = self.pairs()[self.arena_number(seed)]
        return _arena(number, world, path)

    def files(self) -> Tuple[Path, ...]:
        return tuple(file for _, *files in self.pairs() for file in files)

    def arena_number(self, seed: int) -> int:
        return seed % len(self.pairs())


@lru_cache(maxsize=32)
def _arena(number: int, world: Path, path: Path) -> Arena:
    return Arena(load_world(world), None, f"BARN {number}", reference_length(_read_path(path)))


def _read_path(file: Path) -> np.ndarray:
    """Read the cells (N, 2) of a reference path. Raises SettingsError."""
    try:
        cells = read_array(file)
        if cells.ndim != 2 or cells.shape[1] != 2 or not np.isfinite(cells).all():
            raise ValueError("no finite cells (N, 2)")
    except (OSError, ValueError, TypeError) as error:
        raise SettingsError(f"{file}: not a reference path ({error})") from None
    return cells


def score(seconds: float, reference_length: float) -> float:
    """Return BARN's score of a run that reached the goal after ``seconds`` [s] (reference path in [m])."""
    optimal = reference_length / REFERENCE_SPEED
    return optimal / min(max(seconds, 2.0 * optimal), 8.0 * optimal)


def reference_length(path_cells: np.ndarray) -> float:
    """Return the length of a path from the start through cells (N, 2) to the goal [m]."""
    goal = START @ GOAL_IN_ODOM
    path_xy = path_cells * 0.15 + (-4.575, 5.075)
    path_xy = np.concatenate(([[START.x, START.y]], path_xy, [[goal.x, goal.y]]))
    return float(np.linalg.norm(np.diff(path_xy, axis=0), axis=1).sum())


def read_barn(table: Table, folder: Path) -> BarnFolder:
    """Read ``barn``: the folder of the worlds."""
    table.allow_only("barn")
    source = BarnFolder(table.path("barn", folder))
    try:
        source.pairs()
    except SettingsError as error:
        raise table.error_at("barn", f"cannot be used: {error}") from None
    return source
