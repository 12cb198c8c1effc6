"""Missions played by workers, their results kept as they come."""

from dataclasses import dataclass
from itertools import islice
from typing import Any, Callable, Dict, Iterable

from distributed import Client, Future, as_completed

from laboratory.errors import WorkersError
from laboratory.results.result import RunKey, RunResult, error_result
from laboratory.results.store import ResultStore
from laboratory.results.version import version
from laboratory.scenario.scenario import Scenario

RETRIES = 2
# Missions that are handed out for each worker: one is played, the next waits.
QUEUED_PER_WORKER = 2


@dataclass(frozen=True, eq=False)
class ScenarioRun:
    """A scenario with one of its seeds; ``digest``: of the scenario."""

    scenario: Scenario
    seed: int
    digest: str

    @property
    def key(self) -> RunKey:
        return RunKey(self.digest, self.seed, version())


class Campaign:
    """Hands out missions a few at a time, so that memory stays the same however many there are.

    ``heard``: called with each result, after it has been kept.
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
        """Plays them all. Raises ResultsError, and WorkersError if there is nobody left to play."""
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
            raise WorkersError("the scheduler is gone; what has been played is kept")
        error = future.exception() if future.status == "error" else None
        if isinstance(error, WorkersError):
            raise error
        if error is None:
            return future.result()
        name = type(error).__name__
        text = "its worker died again and again" if name == "KilledWorker" else f"{name}: {error}"
        return error_result(RuntimeError(text), run.key)


def run_on_worker(scenario: Scenario, key: RunKey) -> RunResult:
    """What a worker does. Raises WorkersError if it has other software than who asks."""
    from laboratory.runner import run_scenario

    if version() != key.version:
        text = f"a worker has another version of the software ({version()}) than this ({key.version})"
        raise WorkersError(text)
    return run_scenario(scenario, key.seed, key.digest)
