"""One scenario played with one seed, in this process."""

import time

from laboratory.over_ros import play_over_ros
from laboratory.results.result import Key, Result, error_of, result_of
from laboratory.results.version import version
from laboratory.scenario.scenario import Scenario
from planar import PlanarError


def play(scenario: Scenario, seed: int, digest: str = "") -> Result:
    """Plays it; the same result for the same scenario, seed and version, but for the wall-clock time.

    ``digest``: of the scenario, if it is known. What makes a run impossible is its result: an error.
    """
    key = Key(digest or scenario.digest(), seed, version())
    began = time.perf_counter()
    try:
        arena = scenario.arena(seed)
        how = play_over_ros if scenario.is_over_ros else scenario.task.play
        played = how(scenario, arena, seed)
    except PlanarError as error:
        return error_of(error, key)
    wall_seconds = time.perf_counter() - began
    return result_of(played, arena, scenario.world.arena_number(seed), key, wall_seconds)
