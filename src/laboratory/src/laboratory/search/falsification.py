"""The search for a case that fails, and for the smallest that still does."""

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

# Metres of clearance from which on a run is no harder for it.
AMPLE_CLEARANCE = 0.4


def robustness(result: RunResult, seconds: float) -> float:
    """The lower the harder; below 0 if the run failed. ``seconds``: that it might have taken.

    A run that could not be played was no case at all.
    """
    if result.outcome == ERROR:
        return 2.0
    if not result.is_success:
        return -1.0
    time_left = 1.0 - (result.seconds or 0.0) / seconds
    room = AMPLE_CLEARANCE if result.clearance is None else min(result.clearance, AMPLE_CLEARANCE)
    lost = min(result.localization_max or 0.0, AMPLE_CLEARANCE)
    return time_left + (room - lost) / AMPLE_CLEARANCE


def shrink_case(case: Case, fails: Callable[[Case], bool]) -> Case:
    """Without each piece without which it fails all the same; each is tried until none can be left out."""
    position = 0
    while position < len(case.elements):
        less = replace(case, elements=case.elements[:position] + case.elements[position + 1 :])
        if fails(less):
            case, position = less, 0
        else:
            position += 1
    return case


class FalsificationSearch:
    """Tries cases of a scenario, the next near to the hardest so far, until one fails.

    Results and the journal of the search are kept in ``folder``, so that it goes on where it was stopped.
    """

    def __init__(self, base: Scenario, case_space: CaseSpace, seed: int, folder: Path):
        self._base, self._case_space, self._folder = base, case_space, folder
        told = json.dumps([base.digest(), version(), asdict(case_space), seed])
        name = f"{base.name}-{hashlib.sha256(told.encode()).hexdigest()[:12]}"
        self._study = Study(folder / "search.journal", name, case_space.space(), seed)
        self._found: Optional[Case] = None
        self.evaluated_count, self.min_robustness = 0, math.inf

    def run(self, client: Any, trials: int) -> Optional[Case]:
        """The first of the cases that failed, None if none did. Raises ResultsError, WorkersError."""
        self._study.run(trials, lambda batch: self._evaluate(client, batch), lambda: self._found is not None)
        return self._found

    def shrink(self, case: Case) -> Tuple[Case, RunResult]:
        """The least of it that fails, and how that went."""
        min_robustness = shrink_case(case, self._fails)
        return min_robustness, run_scenario(min_robustness.scenario(self._base), min_robustness.seed)

    def _evaluate(self, client: Any, batch: Sequence[Mapping[str, Any]]) -> List[float]:
        """How easy each of a batch was."""
        cases = [self._case_space.case(self._base, values) for values in batch]
        scenarios = [case.scenario(self._base) for case in cases]
        evaluation = Evaluation(scenarios, None, self._folder / "results.sqlite")
        try:
            evaluation.run_on(client)
            eases = [robustness(each.results[0], each.scenario.seconds) for each in evaluation.evaluated()]
        finally:
            evaluation.close()
        failed = [case for case, easy in zip(cases, eases) if easy < 0.0]
        self._found = failed[0] if failed else None
        self.evaluated_count, self.min_robustness = (
            self.evaluated_count + len(batch),
            min(self.min_robustness, *eases),
        )
        print(
            f"  {self.evaluated_count} cases run, {len(failed)} of the last batch failed, "
            f"minimum robustness {self.min_robustness:.2f}"
        )
        return eases

    def _fails(self, case: Case) -> bool:
        result = run_scenario(case.scenario(self._base), case.seed)
        print(f"  {len(case.elements)} pieces: {result.outcome}")
        return robustness(result, self._base.seconds) < 0.0
