"""Optuna study evaluated in batches, so that its course does not depend on the number of workers."""

import warnings
from pathlib import Path
from typing import Any, Callable, List, Mapping, Sequence

import optuna
from optuna.distributions import BaseDistribution
from optuna.storages import JournalStorage
from optuna.storages.journal import JournalFileBackend
from optuna.trial import TrialState

from laboratory.errors import ResultsError

# Trials sampled together; their costs are reported in the same order.
BATCH = 8
Values = Mapping[str, Any]


class Study:
    """Minimization of a cost; the journal file makes it resumable.

    Equal name, space, seed and costs give equal values, also after an interruption.

    Args:
        journal: Journal file.
        name: Name of the study in the journal.
        space: Distribution of each value.
        seed: Seed of the sampler.

    Raises:
        ResultsError: The journal cannot be used.
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
        """Evaluate batches of trials.

        Args:
            trials: Number of trials, including those in the journal.
            costs_of: Costs of the values of a batch.
            is_done: Called after each batch; True ends the search.
        """
        self._fail_interrupted_trials()
        while len(self._completed_trials()) < trials and not is_done():
            done = len(self._completed_trials())
            self._study.sampler = optuna.samplers.TPESampler(
                seed=hash((self._seed, done)) % 2**32, multivariate=True, constant_liar=True
            )
            batch = [self._study.ask(self._space) for _ in range(min(BATCH, trials - done))]
            for trial, cost in zip(batch, costs_of([trial.params for trial in batch])):
                self._study.tell(trial, cost)

    @property
    def best(self) -> Values:
        """Values with the lowest cost; the first of equals."""
        return self._study.best_params

    def _completed_trials(self) -> List[Any]:
        return self._study.get_trials(deepcopy=False, states=(TrialState.COMPLETE,))

    def _fail_interrupted_trials(self) -> None:
        for trial in self._study.get_trials(deepcopy=False, states=(TrialState.RUNNING,)):
            self._study.tell(trial.number, state=TrialState.FAIL)
