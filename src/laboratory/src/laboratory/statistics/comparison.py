"""Paired comparison of two planners or two versions on the same seeds."""

from dataclasses import dataclass
from typing import Dict, Optional, Sequence

import numpy as np
from scipy.stats import wilcoxon
from statsmodels.stats.contingency_tables import mcnemar

from laboratory.results.result import RunResult
from laboratory.statistics.summary import CONFIDENCE, ConfidenceInterval, mean

BETTER, WORSE, UNDECIDED = "better", "worse", "undecided"


@dataclass(frozen=True)
class Comparison:
    """Comparison of the second of two sets of runs with the first, on the seeds of both.

    Attributes:
        pairs: Number of seeds in common.
        gained: Seeds on which only the second succeeded.
        lost: Seeds on which only the first succeeded.
        p_success: p-value of McNemar's exact test.
        seconds: Mean additional time [s] of the second where both succeeded; None if there is no difference.
        p_seconds: p-value of Wilcoxon's signed-rank test of the times.
    """

    pairs: int
    gained: int
    lost: int
    p_success: float
    seconds: Optional[ConfidenceInterval] = None
    p_seconds: Optional[float] = None

    @property
    def success(self) -> str:
        """Better, worse or undecided in success."""
        return _verdict(self.p_success, self.gained - self.lost)

    @property
    def time(self) -> str:
        """Better, worse or undecided in time."""
        if self.seconds is None or self.p_seconds is None:
            return UNDECIDED
        return _verdict(self.p_seconds, -self.seconds.value)


def compare(first: Sequence[RunResult], second: Sequence[RunResult]) -> Comparison:
    """Compare the runs of two planners or versions, paired by seed."""
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
        return UNDECIDED
    return BETTER if gain > 0 else WORSE
