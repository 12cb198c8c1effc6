"""Scenario runs distributed to Dask workers; each result is stored as soon as it arrives."""

from dataclasses import dataclass
from itertools import islice
from typing import Any, Callable, Dict, Iterable

from distributed import Client, Future, as_completed

from laboratory.campaign.workers import MAX_WORKER_DEATHS
from laboratory.errors import WorkersError
from laboratory.results.result import RunKey, RunResult, error_result
from laboratory.results.store import ResultStore
from laboratory.results.version import version
from laboratory.scenario.scenario import Scenario

RETRIES = 2
# Runs submitted for each worker: one in progress, one queued.
QUEUED_PER_WORKER = 2


@dataclass(frozen=True, eq=False)
class ScenarioRun:
    """One run of a campaign.

    Attributes:
        scenario: The scenario to run.
        seed: Seed of the run.
        digest: ``scenario.digest()``, which is costly to compute.
    """

    scenario: Scenario
    seed: int
    digest: str

    @property
    def key(self) -> RunKey:
        return RunKey(self.digest, self.seed, version())


class Campaign:
    """Submits runs a few at a time, so that memory use does not depend on their number.

    Args:
        client: Connection to the workers.
        store: Store to which every result is added.
        on_result: Called with each run and its result, after the result has been stored.
        workers: Number of workers.
    """

    def __init__(
        self,
        client: Client,
        store: ResultStore,
        on_result: Callable[[ScenarioRun, RunResult], None],
        workers: int,
    ):
        self._client, self._store, self._on_result = client, store, on_result
        self._max_submitted = QUEUED_PER_WORKER * workers
        self._submitted: Dict[str, ScenarioRun] = {}

    def run(self, runs: Iterable[ScenarioRun]) -> None:
        """Execute all runs.

        Raises:
            ResultsError: A result cannot be stored.
            WorkersError: No worker is left, or one has another version of the software.
        """
        pending = iter(runs)
        first = [self._submit(run) for run in islice(pending, self._max_submitted)]
        completed = as_completed(first, loop=self._client.loop)
        for future in completed:
            run = self._submitted.pop(future.key)
            result = self._result_of(future, run)
            self._store.add(result)
            self._on_result(run, result)
            future.release()
            for next_run in islice(pending, 1):
                completed.add(self._submit(next_run))

    def _submit(self, run: ScenarioRun) -> Future:
        key = f"play-{run.digest}-{run.seed}"
        self._submitted[key] = run
        work = (run.scenario, run.key)
        return self._client.submit(run_on_worker, *work, key=key, retries=RETRIES, pure=False)

    def _result_of(self, future: Any, run: ScenarioRun) -> RunResult:
        if future.status in ("cancelled", "lost"):
            raise WorkersError("lost the connection to the scheduler; finished runs are stored")
        error = future.exception() if future.status == "error" else None
        if isinstance(error, WorkersError):
            raise error
        if error is None:
            return future.result()
        if type(error).__name__ == "KilledWorker":
            text = f"the worker process died {MAX_WORKER_DEATHS} times"
        else:
            text = f"{type(error).__name__}: {error}"
        return error_result(RuntimeError(text), run.key)


def run_on_worker(scenario: Scenario, key: RunKey) -> RunResult:
    """Run a scenario in a worker process.

    Raises:
        WorkersError: The worker has another version of the software than the process that submitted the run.
    """
    from laboratory.runner import run_scenario

    if version() != key.version:
        text = f"a worker has another version of the software: {version()}, expected {key.version}"
        raise WorkersError(text)
    return run_scenario(scenario, key.seed, key.digest)
