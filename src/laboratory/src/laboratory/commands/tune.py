from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Sequence, Tuple

from home_service.options import count, seed
from supervision.command_line import argument, option


@dataclass(frozen=True)
class Tune:
    """Looks for parameters of move_base that are better on suites, and proves the gain on others."""

    suites: Tuple[str, ...] = argument("what is tuned on: as of evaluate.sh", nargs="+", metavar="SUITE")
    prove: Optional[Tuple[str, ...]] = option(
        None, "suites on which the gain is to be proved (needed)", nargs="+", metavar="SUITE"
    )
    space: Path = option(
        Path("scenarios/tuning/mppi.yaml"), "parameters and their bounds", type=Path, metavar="FILE"
    )
    trials: int = option(64, "candidates that are tried", type=count)
    seeds: str = option("0-9", "that candidates are tried on", metavar="SEEDS")
    proof_seeds: str = option("1000-1099", "that the gain is proved on", metavar="SEEDS")
    seed: int = option(0, "of the search", type=seed)
    workers: Optional[int] = option(None, "processes (default: one for each core)", type=count)
    scheduler: str = option("", "Dask's, instead of processes here: tcp://HOST:8786", metavar="ADDRESS")
    output: Path = option(Path("runs/tune"), "what is found is kept here", type=Path)

    def run(self) -> int:
        from laboratory.campaign import Workers
        from laboratory.scenario.seeds import seeds_of
        from laboratory.search.tuning import TUNED, Tuning, read_space, text_of
        from planar import SettingsError, write_atomically
        from supervision.interruption import raise_when_interrupted

        if not self.prove:
            raise SettingsError("--prove: on which other suites is the gain to be proved?")
        seeds, proof_seeds = seeds_of(self.seeds), seeds_of(self.proof_seeds)
        tuned_on, proved_on = self._scenarios(self.suites), self._scenarios(self.prove)
        both = {each.digest() for each in tuned_on} & {each.digest() for each in proved_on}
        if both and set(seeds) & set(proof_seeds):
            raise SettingsError("--proof-seeds: of the same suite, they must be others than --seeds")
        raise_when_interrupted()
        tuning = Tuning(tuned_on, seeds, read_space(self.space), self.seed, self.output)
        with Workers(self.workers or 0, self.scheduler).client() as client:
            values = tuning.run(client, self.trials)
            write_atomically(self.output / TUNED, text_of(values).encode("utf-8"))
            print(f"the best of {self.trials}, in {self.output / TUNED}:\n{text_of(values)}", end="")
            return self._prove(client, proved_on, proof_seeds, values)

    def _scenarios(self, suites: Sequence[str]) -> Sequence[Any]:
        from laboratory.suites import scenarios_of
        from planar import SettingsError

        scenarios, complaints = scenarios_of(suites)
        if complaints:
            raise SettingsError(complaints[0])
        return scenarios

    def _prove(self, client: Any, scenarios: Sequence[Any], seeds: Tuple[int, ...], values: Any) -> int:
        """Plays them with the usual and with the tuned parameters; 0 if some are better and none worse."""
        from laboratory.evaluation import Evaluation
        from laboratory.page.page import verdict
        from laboratory.search.tuning import RESULTS, with_values
        from laboratory.statistics.comparison import BETTER, WORSE, compare

        both = [*scenarios, *(with_values(each, values) for each in scenarios)]
        evaluation = Evaluation(both, seeds, self.output / RESULTS)
        try:
            evaluation.play_on(client)
            evaluated = evaluation.evaluated()
        finally:
            evaluation.close()
        said = []
        for before, after in zip(evaluated, evaluated[len(scenarios) :]):
            comparison = compare(before.results, after.results)
            said += [comparison.success, comparison.time]
            print(f"{before.scenario.label}, {comparison.pairs} seeds: {verdict(comparison)}")
        is_proved = BETTER in said and WORSE not in said
        print("the gain is proved" if is_proved else "no gain is proved")
        return 0 if is_proved else 1
