"""Suites evaluated: played as far as they have not been yet, and told of."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, List, Optional, Sequence, Tuple

from laboratory.campaign import Campaign, Mission, Workers
from laboratory.campaign.progress import Told
from laboratory.campaign.workers import count_of
from laboratory.results.result import Result
from laboratory.results.store import Store
from laboratory.results.version import version
from laboratory.scenario.scenario import Scenario
from laboratory.statistics.summary import Summary, summary
from planar import SettingsError


@dataclass(frozen=True, eq=False)
class Evaluated:
    """A scenario and its results of this version, of the seeds asked for."""

    scenario: Scenario
    digest: str
    results: Sequence[Result]

    @property
    def summary(self) -> Summary:
        return summary(self.results)


class Evaluation:
    """Scenarios with their seeds, over one file of results."""

    def __init__(self, scenarios: Sequence[Scenario], seeds: Optional[Tuple[int, ...]], results: Path):
        self._scenarios = [(scenario, scenario.digest(), seeds or scenario.seeds) for scenario in scenarios]
        self._store = Store(results)

    def play(self, workers: Workers) -> None:
        """Plays what is not in the file yet. Raises ResultsError, WorkersError."""
        missions, total = self.missions()
        print(f"version {version()}: {total} missions, {total - len(missions)} of them played before")
        if not missions:
            return
        with workers.client() as client, Told(len(missions)) as told:
            self.play_on(client, told.count)

    def play_on(self, client: Any, heard: Callable[[bool], None] = lambda is_success: None) -> None:
        """The same by workers that are there; ``heard``: told of each run whether it succeeded."""
        missions, _ = self.missions()
        campaign = Campaign(client, self._store, lambda _, run: heard(run.is_success), count_of(client))
        campaign.run(missions)

    def missions(self) -> Tuple[List[Mission], int]:
        """Those that have not been played, and how many there are in all."""
        played = self._store.played(version())
        missions = {
            (digest, seed): Mission(scenario, seed, digest)
            for scenario, digest, seeds in self._scenarios
            for seed in seeds
            if (digest, seed) not in played
        }
        return list(missions.values()), sum(len(seeds) for _, _, seeds in self._scenarios)

    def version_like(self, beginning: str) -> str:
        """The latest version in the file that begins so. Raises SettingsError."""
        known = self._store.versions()
        found = [each for each in known if each.startswith(beginning)]
        if not found:
            raise SettingsError(f"--against: no results of {beginning}, but of {', '.join(known) or 'none'}")
        return found[-1]

    def evaluated(self, of_version: str = "") -> List[Evaluated]:
        """What there is in the file, of this or another version."""
        found = []
        for scenario, digest, seeds in self._scenarios:
            wanted = set(seeds)
            results = self._store.results(digest, of_version or version())
            found.append(Evaluated(scenario, digest, [run for run in results if run.seed in wanted]))
        return found

    def close(self) -> None:
        self._store.close()
