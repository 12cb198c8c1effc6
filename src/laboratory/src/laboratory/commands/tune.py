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
        from laboratory.scenario.seeds import parse_seeds
        from laboratory.search.tuning import TUNED, Tuning, parameter_file_text, read_space
        from planar import SettingsError, write_atomically
        from supervision.interruption import raise_when_interrupted

        if not self.prove:
            raise SettingsError("--prove: on which other suites is the gain to be proved?")
        seeds, proof_seeds = parse_seeds(self.seeds), parse_seeds(self.proof_seeds)
        tuned_on, proved_on = self._scenarios(self.suites), self._scenarios(self.prove)
        candidates = {each.digest() for each in tuned_on} & {each.digest() for each in proved_on}
        if candidates and set(seeds) & set(proof_seeds):
            raise SettingsError("--proof-seeds: of the same suite, they must be others than --seeds")
        raise_when_interrupted()
        tuning = Tuning(tuned_on, seeds, read_space(self.space), self.seed, self.output)
        with Workers(self.workers or 0, self.scheduler).client() as client:
            values = tuning.run(client, self.trials)
            text, file = parameter_file_text(values), self.output / TUNED
            write_atomically(file, text.encode("utf-8"))
            print(f"best of {self.trials} candidates, written to {file}:\n{text}", end="")
            return self._compare_gain(client, proved_on, proof_seeds, values)

    def _scenarios(self, suites: Sequence[str]) -> Sequence[Any]:
        from laboratory.suites import load_suites
        from planar import SettingsError

        scenarios, errors = load_suites(suites)
        if errors:
            raise SettingsError(errors[0])
        return scenarios

    def _compare_gain(
        self, client: Any, scenarios: Sequence[Any], seeds: Tuple[int, ...], values: Any
    ) -> int:
        """Plays them with the usual and with the tuned parameters; 0 if some are better and none worse."""
        from laboratory.evaluation import Evaluation
        from laboratory.page.page import comparison_text
        from laboratory.search.tuning import RESULTS, with_values
        from laboratory.statistics.comparison import BETTER, WORSE, compare

        candidates = [*scenarios, *(with_values(each, values) for each in scenarios)]
        evaluation = Evaluation(candidates, seeds, self.output / RESULTS)
        try:
            evaluation.run_on(client)
            evaluated = evaluation.evaluated()
        finally:
            evaluation.close()
        verdicts = []
        for before, after in zip(evaluated, evaluated[len(scenarios) :]):
            comparison = compare(before.results, after.results)
            verdicts += [comparison.success, comparison.time]
            print(f"{before.scenario.label}, {comparison.pairs} seeds: {comparison_text(comparison)}")
        is_proved = BETTER in verdicts and WORSE not in verdicts
        print("the gain is proved" if is_proved else "no gain is proved")
        return 0 if is_proved else 1
