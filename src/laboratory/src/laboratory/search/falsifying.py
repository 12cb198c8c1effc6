"""The search for a case that fails, and for the smallest that still does."""

import hashlib
import json
import math
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Callable, List, Mapping, Optional, Sequence, Tuple

from laboratory.evaluation import Evaluation
from laboratory.playing import play
from laboratory.results.result import Result
from laboratory.results.version import version
from laboratory.scenario.scenario import Scenario
from laboratory.search.cases import Case, Ingredients
from laboratory.search.study import Study
from laboratory.tasks.task import ERROR

# Metres of clearance from which on a run is no harder for it.
ROOMY = 0.4


def ease(result: Result, seconds: float) -> float:
    """The lower the harder; below 0 if the run failed. ``seconds``: that it might have taken.

    A run that could not be played was no case at all.
    """
    if result.outcome == ERROR:
        return 2.0
    if not result.is_success:
        return -1.0
    time_left = 1.0 - (result.seconds or 0.0) / seconds
    room = ROOMY if result.clearance is None else min(result.clearance, ROOMY)
    lost = min(result.localization_max or 0.0, ROOMY)
    return time_left + (room - lost) / ROOMY


def shrunk(case: Case, fails: Callable[[Case], bool]) -> Case:
    """Without each piece without which it fails all the same; each is tried until none can be left out."""
    position = 0
    while position < len(case.pieces):
        less = replace(case, pieces=case.pieces[:position] + case.pieces[position + 1 :])
        if fails(less):
            case, position = less, 0
        else:
            position += 1
    return case


class Search:
    """Tries cases of a scenario, the next near to the hardest so far, until one fails.

    Results and the journal of the search are kept in ``folder``, so that it goes on where it was stopped.
    """

    def __init__(self, base: Scenario, ingredients: Ingredients, seed: int, folder: Path):
        self._base, self._ingredients, self._folder = base, ingredients, folder
        told = json.dumps([base.digest(), version(), asdict(ingredients), seed])
        name = f"{base.name}-{hashlib.sha256(told.encode()).hexdigest()[:12]}"
        self._study = Study(folder / "search.journal", name, ingredients.space(), seed)
        self._found: Optional[Case] = None
        self.tried, self.least = 0, math.inf

    def run(self, client: Any, trials: int) -> Optional[Case]:
        """The first of the cases that failed, None if none did. Raises ResultsError, WorkersError."""
        self._study.run(trials, lambda batch: self._play(client, batch), lambda: self._found is not None)
        return self._found

    def shrink(self, case: Case) -> Tuple[Case, Result]:
        """The least of it that fails, and how that went."""
        least = shrunk(case, self._fails)
        return least, play(least.scenario(self._base), least.seed)

    def _play(self, client: Any, batch: Sequence[Mapping[str, Any]]) -> List[float]:
        """How easy each of a batch was."""
        cases = [self._ingredients.case(self._base, values) for values in batch]
        scenarios = [case.scenario(self._base) for case in cases]
        evaluation = Evaluation(scenarios, None, self._folder / "results.sqlite")
        try:
            evaluation.play_on(client)
            eases = [ease(each.results[0], each.scenario.seconds) for each in evaluation.evaluated()]
        finally:
            evaluation.close()
        failed = [case for case, easy in zip(cases, eases) if easy < 0.0]
        self._found = failed[0] if failed else None
        self.tried, self.least = self.tried + len(batch), min(self.least, *eases)
        print(f"  {self.tried} cases played, {len(failed)} of the last failed, least ease {self.least:.2f}")
        return eases

    def _fails(self, case: Case) -> bool:
        result = play(case.scenario(self._base), case.seed)
        print(f"  {len(case.pieces)} pieces: {result.outcome}")
        return ease(result, self._base.seconds) < 0.0
