"""Figures of a scenario with their confidence intervals."""

from dataclasses import dataclass
from operator import attrgetter
from typing import Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from scipy.stats import bootstrap
from statsmodels.stats.proportion import proportion_confint

from laboratory.results.result import RunResult
from laboratory.tasks.task import COLLISION, ERROR, FAILURE, OUTCOMES, TIMEOUT

# Confidence of all intervals; resamples, seed and batch size of the bootstrap.
CONFIDENCE = 0.95
RESAMPLES, SEED, BATCH = 4000, 0, 50

# Figures of scenarios with pedestrians; all are means.
PEDESTRIAN_FIGURES = (
    *("ran_into_robot", "intimate", "personal", "social", "person_nearest", "person_distance"),
    "social_work",
)


class ConfidenceInterval(NamedTuple):
    """A figure with its 95 % confidence interval."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.4g} [{self.low:.4g}, {self.high:.4g}]"


@dataclass(frozen=True)
class Summary:
    """Figures of the runs of a scenario.

    Attributes:
        runs: Number of runs.
        outcomes: Number of runs by outcome.
        figures: Figures by name: success, collision, timeout, failure and error are shares of the runs, all
            others are means.
    """

    runs: int
    outcomes: Dict[str, int]
    figures: Dict[str, ConfidenceInterval]


def summary(results: Sequence[RunResult]) -> Summary:
    """Summarize the runs of a scenario; times and path lengths are those of successful runs."""
    outcomes = {name: sum(result.outcome == name for result in results) for name in OUTCOMES}
    figures = {name: share(count, len(results)) for name, count in outcomes.items()}
    won = [result for result in results if result.is_success]
    rows: List[Tuple[str, Sequence[RunResult], Callable[[RunResult], Optional[float]]]] = [
        ("seconds", won, lambda run: run.seconds),
        ("driven", won, lambda run: run.driven),
        ("spl", results, success_weighted_by_path_length),
        ("score", results, lambda run: run.score),
        ("clearance", results, lambda run: run.clearance),
        ("turning", won, lambda run: run.turning),
        ("localization", results, lambda run: run.localization_mean),
        ("still", won, lambda run: run.still),
        *((name, results, attrgetter(name)) for name in PEDESTRIAN_FIGURES),
    ]
    for name, of, values in rows:
        values_present = _without_none(of, values)
        if values_present:
            figures[name] = mean(values_present)
    return Summary(len(results), outcomes, figures)


# All figures, which --require accepts.
FIGURES = (
    *("success", COLLISION, TIMEOUT, FAILURE, ERROR),
    *("seconds", "driven", "spl", "score", "clearance", "turning", "localization", "still"),
    *PEDESTRIAN_FIGURES,
)


def share(count: int, total: int) -> ConfidenceInterval:
    """Return a proportion with Wilson's interval (Wilson, 1927)."""
    if total == 0:
        return ConfidenceInterval(float("nan"), 0.0, 1.0)
    low, high = proportion_confint(count, total, alpha=1.0 - CONFIDENCE, method="wilson")
    return ConfidenceInterval(count / total, float(low), float(high))


def mean(values: Sequence[float]) -> ConfidenceInterval:
    """Return a mean with the percentile interval of a seeded bootstrap (Efron, 1979)."""
    sample = np.asarray(values, dtype=float)
    middle = float(sample.mean())
    if len(sample) < 2 or np.ptp(sample) == 0.0:
        return ConfidenceInterval(middle, middle, middle)
    interval = bootstrap(
        (sample,),
        np.mean,
        confidence_level=CONFIDENCE,
        n_resamples=RESAMPLES,
        batch=BATCH,
        method="percentile",
        random_state=np.random.default_rng(SEED),
    ).confidence_interval
    return ConfidenceInterval(middle, float(interval.low), float(interval.high))


def success_weighted_by_path_length(run: RunResult) -> Optional[float]:
    """Success weighted by path length (SPL; Anderson et al., 2018)."""
    if run.way is None or run.driven is None:
        return None
    return run.is_success * run.way / max(run.way, run.driven)


def _without_none(results: Sequence[RunResult], value: Callable[[RunResult], Optional[float]]) -> List[float]:
    return [found for found in map(value, results) if found is not None]
