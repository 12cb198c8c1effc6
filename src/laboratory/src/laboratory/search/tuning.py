"""Which parameters of move_base are tuned, within which bounds, and how good some values are."""

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
    """Bounds of parameters, by names as ``MppiPlannerROS/safe_distance``, out of nested tables whose leaves
    are [least, greatest]. Raises SettingsError.
    """
    return dict(_bounds(read_table(path), ""))


def _bounds(table: Table, above: str) -> Iterator[Tuple[str, BaseDistribution]]:
    for key in table:
        if isinstance(table.value(key), dict):
            yield from _bounds(table.table(key), f"{above}{key}{SEPARATOR}")
            continue
        low, high = table.numbers(key, "least, greatest")
        table.check(low < high, key, "two numbers, the lesser first")
        yield above + key, FloatDistribution(low, high)


def nested(values: Values) -> Dict[str, Any]:
    """As move_base's parameters are written."""
    tables: Dict[str, Any] = {}
    for name, value in values.items():
        *above, key = name.split(SEPARATOR)
        table = tables
        for part in above:
            table = table.setdefault(part, {})
        table[key] = value
    return tables


def with_values(scenario: Scenario, values: Values) -> Scenario:
    """The scenario with these over its own parameters."""
    return scenario.with_parameters(merged(scenario.parameters, nested(values)))


def cost(scenario: Scenario, results: Sequence[RunResult]) -> float:
    """Mean simulated seconds of the runs; one that failed counts as one that used up all its time, twice."""
    seconds = [
        result.seconds if result.is_success and result.seconds is not None else 2.0 * scenario.seconds
        for result in results
    ]
    return sum(seconds) / len(seconds)


def costs(evaluated: Sequence[EvaluatedScenario], count: int) -> List[float]:
    """Of ``count`` candidates, each of which has as many of the evaluated scenarios, in turn."""
    each = len(evaluated) // count
    groups = [evaluated[number * each : (number + 1) * each] for number in range(count)]
    return [sum(cost(one.scenario, one.results) for one in group) / each for group in groups]


def parameter_file_text(values: Values) -> str:
    """As a file of parameters that move_base loads."""
    return yaml.safe_dump(nested(values), sort_keys=True)


class Tuning:
    """Looks for values of a ``space`` that make scenarios cheap, over their ``seeds``.

    Results and the journal are kept in ``folder``, so that it goes on where it was stopped.
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
        told = json.dumps([digests, seeds, bounds, version(), seed])
        name = hashlib.sha256(told.encode()).hexdigest()[:12]
        self._study = Study(folder / "search.journal", f"tune-{name}", space, seed)
        self._tried, self._least = 0, math.inf

    def run(self, client: Any, trials: int) -> Values:
        """The best values of so many. Raises ResultsError, WorkersError."""
        self._study.run(trials, lambda batch: self._evaluate(client, batch))
        return self._study.best

    def _evaluate(self, client: Any, batch: Sequence[Values]) -> List[float]:
        """What each of a batch costs."""
        candidates = [with_values(each, values) for values in batch for each in self._scenarios]
        evaluation = Evaluation(candidates, self._seeds, self._folder / RESULTS)
        try:
            evaluation.run_on(client)
            told = costs(evaluation.evaluated(), len(batch))
        finally:
            evaluation.close()
        self._tried, self._least = self._tried + len(batch), min(self._least, *told)
        print(f"  {self._tried} candidates played, the best costs {self._least:.2f} s")
        return told
