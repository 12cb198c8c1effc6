"""Tuning of move_base parameters: search space, cost and search."""

import hashlib
import json
import math
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

import yaml
from optuna.distributions import BaseDistribution, FloatDistribution

from laboratory.evaluation import EvaluatedScenario, Evaluation
from laboratory.results.result import RunResult
from laboratory.results.version import version
from laboratory.scenario.scenario import Scenario
from laboratory.search.study import Study
from move_base_lite.parameters import merged
from planar.config.yaml_table import Table, read_table

SEPARATOR = "/"
Values = Mapping[str, Any]
TUNED, RESULTS = "tuned.yaml", "results.sqlite"


def read_space(path: Path) -> Dict[str, BaseDistribution]:
    """Read the bounds of parameters from nested tables whose leaves are [lower, upper].

    Returns:
        A distribution for each name, such as ``MppiPlannerROS/safe_distance``.

    Raises:
        SettingsError: The file is not such a table.
    """
    return dict(_bounds(read_table(path), ""))


def _bounds(table: Table, prefix: str) -> Iterator[Tuple[str, BaseDistribution]]:
    for key in table:
        if isinstance(table.value(key), dict):
            yield from _bounds(table.table(key), f"{prefix}{key}{SEPARATOR}")
            continue
        low, high = table.numbers(key, "lower, upper")
        table.check(low < high, key, "two numbers, the lesser first")
        yield prefix + key, FloatDistribution(low, high)


def nested(values: Values) -> Dict[str, Any]:
    """Return values as nested tables of move_base parameters."""
    tables: Dict[str, Any] = {}
    for name, value in values.items():
        *prefix, key = name.split(SEPARATOR)
        table = tables
        for part in prefix:
            table = table.setdefault(part, {})
        table[key] = value
    return tables


def with_values(scenario: Scenario, values: Values) -> Scenario:
    """Return the scenario with these values merged over its parameters."""
    return scenario.with_parameters(merged(scenario.parameters, nested(values)))


def cost(scenario: Scenario, results: Sequence[RunResult]) -> float:
    """Return the mean simulated time of the runs [s]; a failed run counts as twice the time limit."""
    seconds = [
        result.seconds if result.is_success and result.seconds is not None else 2.0 * scenario.seconds
        for result in results
    ]
    return sum(seconds) / len(seconds)


def costs(evaluated: Sequence[EvaluatedScenario], count: int) -> List[float]:
    """Return the costs of ``count`` candidates, whose scenarios follow each other in equal numbers."""
    each = len(evaluated) // count
    groups = [evaluated[number * each : (number + 1) * each] for number in range(count)]
    return [sum(cost(one.scenario, one.results) for one in group) / each for group in groups]


def parameter_file_text(values: Values) -> str:
    """Return values as a parameter file of move_base."""
    return yaml.safe_dump(nested(values), sort_keys=True)


class Tuning:
    """Search for parameters that minimize the cost of scenarios.

    Args:
        scenarios: Scenarios to tune on.
        seeds: Seeds each candidate runs with; None: those of the scenario.
        space: Distribution of each parameter.
        seed: Seed of the search.
        folder: Folder of the results and the journal, from which an interrupted search continues.
    """

    def __init__(
        self,
        scenarios: Sequence[Scenario],
        seeds: Optional[Tuple[int, ...]],
        space: Mapping[str, BaseDistribution],
        seed: int,
        folder: Path,
    ):
        self._scenarios, self._seeds, self._folder = scenarios, seeds, folder
        bounds = {name: str(each) for name, each in space.items()}
        digests = [scenario.digest() for scenario in scenarios]
        key = json.dumps([digests, seeds, bounds, version(), seed])
        name = hashlib.sha256(key.encode()).hexdigest()[:12]
        self._study = Study(folder / "search.journal", f"tune-{name}", space, seed)
        self._tried, self._min_cost = 0, math.inf

    def run(self, client: Any, trials: int) -> Values:
        """Return the best values of ``trials`` candidates. Raises ResultsError, WorkersError."""
        self._study.run(trials, lambda batch: self._evaluate(client, batch))
        return self._study.best

    def _evaluate(self, client: Any, batch: Sequence[Values]) -> List[float]:
        """Run a batch of candidates; return the cost of each."""
        candidates = [with_values(each, values) for values in batch for each in self._scenarios]
        evaluation = Evaluation(candidates, self._seeds, self._folder / RESULTS)
        try:
            evaluation.run_on(client)
            batch_costs = costs(evaluation.evaluated(), len(batch))
        finally:
            evaluation.close()
        self._tried, self._min_cost = self._tried + len(batch), min(self._min_cost, *batch_costs)
        print(f"  {self._tried} candidates run, lowest cost {self._min_cost:.2f} s")
        return batch_costs
