"""One scenario played with one seed, in this process."""

import time

from laboratory.over_ros import run_over_ros
from laboratory.results.result import RunKey, RunResult, error_result, measured_result
from laboratory.results.version import version
from laboratory.scenario.scenario import Scenario
from planar import PlanarError


def run_scenario(scenario: Scenario, seed: int, digest: str = "") -> RunResult:
    """Plays it; the same result for the same scenario, seed and version, but for the wall-clock time.

    ``digest``: of the scenario, if it is known. What makes a run impossible is its result: an error.
    """
    key = RunKey(digest or scenario.digest(), seed, version())
    start = time.perf_counter()
    try:
        arena = scenario.arena(seed)
        run = run_over_ros if scenario.is_over_ros else scenario.task.run
        trace = run(scenario, arena, seed)
    except PlanarError as error:
        return error_result(error, key)
    wall_seconds = time.perf_counter() - start
    return measured_result(trace, arena, scenario.world.arena_number(seed), key, wall_seconds)
