"""Contract checks of a custom world generator: ``python3 -m laboratory.check NAME``."""

import sys
from typing import Any, Tuple

import numpy as np

from laboratory.worlds.custom import CONTRACT, CustomWorlds, load_generator
from laboratory.worlds.source import Arena, WorldSource
from planar import FREE
from planar.plugin_check import CheckSuite, expect, plugin_finder, run_checks
from planar.plugins import PluginError
from sim_bridge import Simulation

SEEDS = range(5)


def gives_a_world_for_each_seed(source: WorldSource) -> None:
    """It generates a world with a floor for each seed."""
    for seed in SEEDS:
        arena = source.arena(seed)
        expect(bool(arena.world.bodies), f"seed {seed}: a world without a floor")
        _first_scans(arena)


def is_deterministic(source: WorldSource) -> None:
    """It is deterministic: the same seed gives the same world."""
    for seed in SEEDS:
        first, _, second = source.arena(seed), source.arena(seed + 1), source.arena(seed)
        expect(
            _fingerprint(first) == _fingerprint(second),
            f"seed {seed}: the second call returned a different world",
        )


def places_are_free(source: WorldSource) -> None:
    """Its places are on free cells of the map."""
    for seed in SEEDS:
        arena = source.arena(seed)
        if arena.grid is not None:
            for place in arena.places:
                is_free = arena.grid.value_at(place.pose.x, place.pose.y) == FREE
                expect(is_free, f"seed {seed}: {place.name} is not on a free cell")


def _fingerprint(arena: Arena) -> Tuple[Any, ...]:
    """All that must be equal in two equal arenas."""
    cells = b"" if arena.grid is None else arena.grid.cells.tobytes()
    bodies = [(body.name, np.asarray(body.pose_in_world).tobytes()) for body in arena.world.bodies]
    return bodies, cells, arena.title, arena.reference_length, arena.places, _first_scans(arena)


def _first_scans(arena: Arena) -> bytes:
    """The scans of a robot at the origin in the first 0.2 s."""
    simulation = Simulation(arena.world)
    try:
        scans = [scan for _ in range(40) for scan in simulation.step().scans]
        return b"".join(scan.ranges.tobytes() for scan in scans)
    finally:
        simulation.close()


def _load_source(name: str) -> CustomWorlds:
    """Load a generator with the default values of its fields. Raises PluginError if one has no default."""
    try:
        return CustomWorlds(name, load_generator(name)())
    except TypeError as error:
        raise PluginError(f"{name} cannot be checked without arguments: {error}") from None


CHECKS = (gives_a_world_for_each_seed, is_deterministic, places_are_free)
CHECK_SUITES = {"world_generator": CheckSuite(plugin_finder(CONTRACT, _load_source), CHECKS)}


if __name__ == "__main__":
    sys.exit(run_checks("laboratory", CHECK_SUITES))
