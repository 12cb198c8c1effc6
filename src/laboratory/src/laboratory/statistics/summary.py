"""The figures of a scenario, with how sure they are."""

from dataclasses import dataclass
from operator import attrgetter
from typing import Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from scipy.stats import bootstrap
from statsmodels.stats.proportion import proportion_confint

from laboratory.results.result import RunResult
from laboratory.tasks.task import COLLISION, ERROR, FAILURE, OUTCOMES, TIMEOUT

# Of intervals; and how often bootstrap draws, from which seed, how many at a time.
CONFIDENCE = 0.95
RESAMPLES, SEED, BATCH = 4000, 0, 50

# Means, where there are people.
OF_PEOPLE = (
    *("ran_into_robot", "intimate", "personal", "social", "person_nearest", "person_distance"),
    "social_work",
)


class ConfidenceInterval(NamedTuple):
    """A figure and the interval that holds it with 95 % confidence; all the same if they cannot differ."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.4g} [{self.low:.4g}, {self.high:.4g}]"


@dataclass(frozen=True)
class Summary:
    """``figures``: by their names, those that there are: success, collision, timeout, failure and error are
    shares of the runs; seconds, driven, spl, score, clearance, turning and localization are means.
    """

    runs: int
    outcomes: Dict[str, int]
    figures: Dict[str, ConfidenceInterval]


def summary(results: Sequence[RunResult]) -> Summary:
    """Of the runs of a scenario. Times and ways are those of the runs that succeeded."""
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
        *((name, results, attrgetter(name)) for name in OF_PEOPLE),
    ]
    for name, of, values in rows:
        known = _known(of, values)
        if known:
            figures[name] = mean(known)
    return Summary(len(results), outcomes, figures)


# What can be told of runs, and asked for by --require.
FIGURES = (
    *("success", COLLISION, TIMEOUT, FAILURE, ERROR),
    *("seconds", "driven", "spl", "score", "clearance", "turning", "localization", "still"),
    *OF_PEOPLE,
)


def share(count: int, total: int) -> ConfidenceInterval:
    """Wilson's interval (Wilson, 1927)."""
    if total == 0:
        return ConfidenceInterval(float("nan"), 0.0, 1.0)
    low, high = proportion_confint(count, total, alpha=1.0 - CONFIDENCE, method="wilson")
    return ConfidenceInterval(count / total, float(low), float(high))


def mean(values: Sequence[float]) -> ConfidenceInterval:
    """With the percentile interval of a seeded bootstrap (Efron, 1979)."""
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
    """Success weighted by the length of the way (SPL; Anderson et al., 2018)."""
    if run.way is None or run.driven is None:
        return None
    return run.is_success * run.way / max(run.way, run.driven)


def _known(results: Sequence[RunResult], value: Callable[[RunResult], Optional[float]]) -> List[float]:
    return [found for found in map(value, results) if found is not None]
