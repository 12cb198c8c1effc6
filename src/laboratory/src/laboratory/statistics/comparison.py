"""Two planners, or two versions, on the same seeds."""

from dataclasses import dataclass
from typing import Dict, Optional, Sequence

import numpy as np
from scipy.stats import wilcoxon
from statsmodels.stats.contingency_tables import mcnemar

from laboratory.results.result import RunResult
from laboratory.statistics.summary import CONFIDENCE, ConfidenceInterval, mean

BETTER, WORSE, NOT_SIGNIFICANT = "better", "worse", "cannot tell"


@dataclass(frozen=True)
class Comparison:
    """What the second of two does to the first, on the ``pairs`` of seeds that both have played.

    ``gained``, ``lost``: seeds that only the second, only the first brought to success; ``p_success``: of
    McNemar's exact test. ``seconds``: how much longer the second took where both succeeded, ``p_seconds``: of
    Wilcoxon's signed-rank test; None if there is nothing to compare.
    """

    pairs: int
    gained: int
    lost: int
    p_success: float
    seconds: Optional[ConfidenceInterval] = None
    p_seconds: Optional[float] = None

    @property
    def success(self) -> str:
        """The verdict on success."""
        return _verdict(self.p_success, self.gained - self.lost)

    @property
    def time(self) -> str:
        """The verdict on the time taken."""
        if self.seconds is None or self.p_seconds is None:
            return NOT_SIGNIFICANT
        return _verdict(self.p_seconds, -self.seconds.value)


def compare(first: Sequence[RunResult], second: Sequence[RunResult]) -> Comparison:
    """Pairs runs by their seeds."""
    of_second: Dict[int, RunResult] = {run.seed: run for run in second}
    pairs = [(run, of_second[run.seed]) for run in first if run.seed in of_second]
    table = np.zeros((2, 2), dtype=int)
    for before, after in pairs:
        table[int(before.is_success), int(after.is_success)] += 1
    gained, lost = int(table[0, 1]), int(table[1, 0])
    p_success = float(mcnemar(table, exact=True).pvalue) if gained + lost else 1.0
    both = [(before, after) for before, after in pairs if before.is_success and after.is_success]
    delays = [(after.seconds or 0.0) - (before.seconds or 0.0) for before, after in both]
    if not any(delays):
        return Comparison(len(pairs), gained, lost, p_success)
    return Comparison(len(pairs), gained, lost, p_success, mean(delays), float(wilcoxon(delays).pvalue))


def _verdict(p: float, gain: float) -> str:
    if p > 1.0 - CONFIDENCE or gain == 0:
        return NOT_SIGNIFICANT
    return BETTER if gain > 0 else WORSE
