"""Evaluation of planners on many seeds: execute the runs without a stored result, then read all results."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, List, Optional, Sequence, Tuple

from laboratory.campaign import Campaign, ScenarioRun, Workers
from laboratory.campaign.progress import CampaignProgress
from laboratory.campaign.workers import worker_count
from laboratory.results.result import RunResult
from laboratory.results.store import ResultStore
from laboratory.results.version import version
from laboratory.scenario.scenario import Scenario
from laboratory.statistics.summary import Summary, summary
from planar import SettingsError


@dataclass(frozen=True, eq=False)
class EvaluatedScenario:
    """A scenario with its stored results.

    Attributes:
        scenario: The scenario.
        digest: Its digest, the key of its results.
        results: Results of one version of the software, for the requested seeds.
    """

    scenario: Scenario
    digest: str
    results: Sequence[RunResult]

    @property
    def summary(self) -> Summary:
        return summary(self.results)


class Evaluation:
    """Scenarios and their seeds, evaluated with one file of results.

    Args:
        scenarios: Scenarios to evaluate.
        seeds: Seeds of all scenarios; None: the seeds of each scenario file.
        results: SQLite file of results.
    """

    def __init__(self, scenarios: Sequence[Scenario], seeds: Optional[Tuple[int, ...]], results: Path):
        self._scenarios = [(scenario, scenario.digest(), seeds or scenario.seeds) for scenario in scenarios]
        self._store = ResultStore(results)

    def run(self, workers: Workers) -> None:
        """Execute all runs without a stored result. Raises ResultsError, WorkersError."""
        runs, total = self.pending_runs()
        print(f"version {version()}: {total} results requested, {total - len(runs)} already stored")
        if not runs:
            return
        with workers.client() as client, CampaignProgress(len(runs)) as progress:
            self.run_on(client, progress.count)

    def run_on(self, client: Any, on_result: Callable[[bool], None] = lambda is_success: None) -> None:
        """Execute them on existing workers; ``on_result`` is called with the success of each run."""
        runs, _ = self.pending_runs()
        campaign = Campaign(
            client, self._store, lambda _, run: on_result(run.is_success), worker_count(client)
        )
        campaign.run(runs)

    def pending_runs(self) -> Tuple[List[ScenarioRun], int]:
        """Return the runs without a stored result, and the total number of runs."""
        completed = self._store.completed(version())
        runs = {
            (digest, seed): ScenarioRun(scenario, seed, digest)
            for scenario, digest, seeds in self._scenarios
            for seed in seeds
            if (digest, seed) not in completed
        }
        return list(runs.values()), sum(len(seeds) for _, _, seeds in self._scenarios)

    def version_with_prefix(self, prefix: str) -> str:
        """Return the latest stored version with this prefix. Raises SettingsError if there is none."""
        versions = self._store.versions()
        matching = [each for each in versions if each.startswith(prefix)]
        if not matching:
            raise SettingsError(
                f"--against: no results of version {prefix}; stored versions: {', '.join(versions) or 'none'}"
            )
        return matching[-1]

    def evaluated(self, of_version: str = "") -> List[EvaluatedScenario]:
        """Return the stored results of all scenarios, of this or of another version."""
        matching = []
        for scenario, digest, seeds in self._scenarios:
            selected = set(seeds)
            results = self._store.results(digest, of_version or version())
            matching.append(
                EvaluatedScenario(scenario, digest, [run for run in results if run.seed in selected])
            )
        return matching

    def close(self) -> None:
        self._store.close()
