"""Run a scenario with one seed."""

import time

from laboratory.over_ros import run_over_ros
from laboratory.results.result import RunKey, RunResult, error_result, measured_result
from laboratory.results.version import version
from laboratory.scenario.scenario import Scenario
from planar import PlanarError


def run_scenario(scenario: Scenario, seed: int, digest: str = "") -> RunResult:
    """Run a scenario with one seed.

    Args:
        scenario: Scenario to run.
        seed: Seed of all random numbers of the run.
        digest: ``scenario.digest()`` if already known.

    Returns:
        The result, equal for equal scenario, seed and software version except for ``wall_seconds``. A run
        that cannot be executed has the outcome ``error`` and the text of the exception as its reason.
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
