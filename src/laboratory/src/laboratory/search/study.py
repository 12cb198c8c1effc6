"""A search by ask and tell (Optuna), in batches, so that it goes the same way however many workers play."""

import warnings
from pathlib import Path
from typing import Any, Callable, List, Mapping, Sequence

import optuna
from optuna.distributions import BaseDistribution
from optuna.storages import JournalStorage
from optuna.storages.journal import JournalFileBackend
from optuna.trial import TrialState

from laboratory.errors import ResultsError

# Trials that are asked for at once, and told of in the order in which they were asked for.
BATCH = 8
Values = Mapping[str, Any]


class Study:
    """Values of a ``space`` that make a cost low; what has been told is kept in a journal file at once.

    The same name, space, seed and costs give the same values, also if it was stopped in between.
    Raises ResultsError for a journal that cannot be used.
    """

    def __init__(self, journal: Path, name: str, space: Mapping[str, BaseDistribution], seed: int):
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        journal.parent.mkdir(parents=True, exist_ok=True)
        self._space, self._seed = dict(space), seed
        try:
            storage = JournalStorage(JournalFileBackend(str(journal)))
            self._study = optuna.create_study(storage=storage, study_name=name, load_if_exists=True)
        except (OSError, ValueError, KeyError) as error:
            raise ResultsError(f"{journal}: cannot be used as a journal ({error})") from None

    def run(
        self,
        trials: int,
        costs_of: Callable[[Sequence[Values]], Sequence[float]],
        is_done: Callable[[], bool] = lambda: False,
    ) -> None:
        """Goes on until so many have been told of, or it ``is_enough`` after a batch.

        ``costs_of``: of the values of a batch, the lower the better.
        """
        self._fail_interrupted_trials()
        while len(self._completed_trials()) < trials and not is_done():
            done = len(self._completed_trials())
            self._study.sampler = optuna.samplers.TPESampler(
                seed=hash((self._seed, done)) % 2**32, multivariate=True, constant_liar=True
            )
            asked = [self._study.ask(self._space) for _ in range(min(BATCH, trials - done))]
            for trial, cost in zip(asked, costs_of([trial.params for trial in asked])):
                self._study.tell(trial, cost)

    @property
    def best(self) -> Values:
        """The values of the least cost so far; of equals, the first."""
        return self._study.best_params

    def _completed_trials(self) -> List[Any]:
        return self._study.get_trials(deepcopy=False, states=(TrialState.COMPLETE,))

    def _fail_interrupted_trials(self) -> None:
        for trial in self._study.get_trials(deepcopy=False, states=(TrialState.RUNNING,)):
            self._study.tell(trial.number, state=TrialState.FAIL)
