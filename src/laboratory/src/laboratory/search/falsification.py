"""Falsification: search for a case that makes a scenario fail, and shrink it."""

import hashlib
import json
import math
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Callable, List, Mapping, Optional, Sequence, Tuple

from laboratory.evaluation import Evaluation
from laboratory.results.result import RunResult
from laboratory.results.version import version
from laboratory.runner import run_scenario
from laboratory.scenario.scenario import Scenario
from laboratory.search.cases import Case, CaseSpace
from laboratory.search.study import Study
from laboratory.tasks.task import ERROR

# Clearance above which a run does not count as more robust [m].
AMPLE_CLEARANCE = 0.4


def robustness(result: RunResult, seconds: float) -> float:
    """Rate how far a run is from failing.

    Args:
        result: Result of the run.
        seconds: Time limit of the run [simulated s].

    Returns:
        A value below 0 for a failed run; otherwise the higher, the more time and clearance were left. A run
        that could not be executed counts as very robust.
    """
    if result.outcome == ERROR:
        return 2.0
    if not result.is_success:
        return -1.0
    time_left = 1.0 - (result.seconds or 0.0) / seconds
    clearance = AMPLE_CLEARANCE if result.clearance is None else min(result.clearance, AMPLE_CLEARANCE)
    error = min(result.localization_max or 0.0, AMPLE_CLEARANCE)
    return time_left + (clearance - error) / AMPLE_CLEARANCE


def shrink_case(case: Case, fails: Callable[[Case], bool]) -> Case:
    """Remove elements one by one as long as the case still fails; return a minimal failing case."""
    position = 0
    while position < len(case.elements):
        smaller = replace(case, elements=case.elements[:position] + case.elements[position + 1 :])
        if fails(smaller):
            case, position = smaller, 0
        else:
            position += 1
    return case


class FalsificationSearch:
    """Searches for the case with the lowest robustness until one fails.

    Args:
        base: Scenario to disturb.
        case_space: Space of its disturbances.
        seed: Seed of the search.
        folder: Folder of the results and the journal, from which an interrupted search continues.
    """

    def __init__(self, base: Scenario, case_space: CaseSpace, seed: int, folder: Path):
        self._base, self._case_space, self._folder = base, case_space, folder
        key = json.dumps([base.digest(), version(), asdict(case_space), seed])
        name = f"{base.name}-{hashlib.sha256(key.encode()).hexdigest()[:12]}"
        self._study = Study(folder / "search.journal", name, case_space.space(), seed)
        self._found: Optional[Case] = None
        self.evaluated_count, self.min_robustness = 0, math.inf

    def run(self, client: Any, trials: int) -> Optional[Case]:
        """Return the first failing case, None if there is none. Raises ResultsError, WorkersError."""
        self._study.run(trials, lambda batch: self._evaluate(client, batch), lambda: self._found is not None)
        return self._found

    def shrink(self, case: Case) -> Tuple[Case, RunResult]:
        """Return a minimal failing case and its result."""
        minimal = shrink_case(case, self._fails)
        return minimal, run_scenario(minimal.scenario(self._base), minimal.seed)

    def _evaluate(self, client: Any, batch: Sequence[Mapping[str, Any]]) -> List[float]:
        """Run a batch of cases; return the robustness of each."""
        cases = [self._case_space.case(self._base, sample) for sample in batch]
        scenarios = [case.scenario(self._base) for case in cases]
        evaluation = Evaluation(scenarios, None, self._folder / "results.sqlite")
        try:
            evaluation.run_on(client)
            values = [robustness(each.results[0], each.scenario.seconds) for each in evaluation.evaluated()]
        finally:
            evaluation.close()
        failed = [case for case, value in zip(cases, values) if value < 0.0]
        self._found = failed[0] if failed else None
        self.evaluated_count += len(batch)
        self.min_robustness = min(self.min_robustness, *values)
        print(
            f"  {self.evaluated_count} cases run, {len(failed)} of the last batch failed, "
            f"minimum robustness {self.min_robustness:.2f}"
        )
        return values

    def _fails(self, case: Case) -> bool:
        result = run_scenario(case.scenario(self._base), case.seed)
        print(f"  {len(case.elements)} elements: {result.outcome}")
        return robustness(result, self._base.seconds) < 0.0
