"""Missions played by workers, their results kept as they come."""

from dataclasses import dataclass
from itertools import islice
from typing import Any, Callable, Dict, Iterable

from distributed import Client, Future, as_completed

from laboratory.errors import WorkersError
from laboratory.results.result import Key, Result, error_of
from laboratory.results.store import Store
from laboratory.results.version import version
from laboratory.scenario.scenario import Scenario

RETRIES = 2
# Missions that are handed out for each worker: one is played, the next waits.
AHEAD = 2


@dataclass(frozen=True, eq=False)
class Mission:
    """A scenario with one of its seeds; ``digest``: of the scenario."""

    scenario: Scenario
    seed: int
    digest: str

    @property
    def key(self) -> Key:
        return Key(self.digest, self.seed, version())


class Campaign:
    """Hands out missions a few at a time, so that memory stays the same however many there are.

    ``heard``: called with each result, after it has been kept.
    """

    def __init__(self, client: Client, store: Store, heard: Callable[[Mission, Result], None], workers: int):
        self._client, self._store, self._heard = client, store, heard
        self._ahead = AHEAD * workers
        self._under_way: Dict[str, Mission] = {}

    def run(self, missions: Iterable[Mission]) -> None:
        """Plays them all. Raises ResultsError, and WorkersError if there is nobody left to play."""
        waiting = iter(missions)
        first = [self._hand_out(mission) for mission in islice(waiting, self._ahead)]
        answers = as_completed(first, loop=self._client.loop)
        for future in answers:
            mission = self._under_way.pop(future.key)
            result = self._answer(future, mission)
            self._store.add(result)
            self._heard(mission, result)
            future.release()
            for following in islice(waiting, 1):
                answers.add(self._hand_out(following))

    def _hand_out(self, mission: Mission) -> Future:
        key = f"play-{mission.digest}-{mission.seed}"
        self._under_way[key] = mission
        work = (mission.scenario, mission.key)
        return self._client.submit(play_elsewhere, *work, key=key, retries=RETRIES, pure=False)

    def _answer(self, future: Any, mission: Mission) -> Result:
        if future.status in ("cancelled", "lost"):
            raise WorkersError("the scheduler is gone; what has been played is kept")
        error = future.exception() if future.status == "error" else None
        if isinstance(error, WorkersError):
            raise error
        if error is None:
            return future.result()
        name = type(error).__name__
        text = "its worker died again and again" if name == "KilledWorker" else f"{name}: {error}"
        return error_of(RuntimeError(text), mission.key)


def play_elsewhere(scenario: Scenario, key: Key) -> Result:
    """What a worker does. Raises WorkersError if it has other software than who asks."""
    from laboratory.playing import play

    if version() != key.version:
        text = f"a worker has another version of the software ({version()}) than this ({key.version})"
        raise WorkersError(text)
    return play(scenario, key.seed, key.digest)
