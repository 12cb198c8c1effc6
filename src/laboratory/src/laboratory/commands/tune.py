from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Sequence, Tuple

from supervision.command_line import argument, count, option, seed


@dataclass(frozen=True)
class Tune:
    """Search for better move_base parameters on some suites, and prove the gain on others.

    Optuna searches for parameters with which the scenarios take less time and fail less; exact tests on the
    same seeds prove the gain. The best are written to tuned.yaml. Ctrl-C loses nothing; the next start
    continues with the same result.

    Exit code: 0 a gain is proved, 1 none is, 2 invalid input, 130 interrupted.
    """

    suites: Tuple[str, ...] = argument(
        "scenarios to tune on (docs/reference/scenarios.md), as for evaluate.sh", nargs="+", metavar="SUITE"
    )
    prove: Optional[Tuple[str, ...]] = option(
        None, "suites on which the gain is proved (required)", nargs="+", metavar="SUITE"
    )
    space: Path = option(Path("scenarios/tuning/mppi.yaml"), "file of parameters and their bounds", type=Path)
    trials: int = option(64, "number of candidates", type=count)
    seeds: str = option("0-9", "seeds of the search", metavar="SEEDS")
    proof_seeds: str = option("1000-1099", "seeds of the proof", metavar="SEEDS")
    seed: int = option(0, "seed of the search", type=seed)
    workers: Optional[int] = option(None, "number of processes (default: one for each core)", type=count)
    scheduler: str = option(
        "", "Dask scheduler instead of local processes: tcp://HOST:8786", metavar="ADDRESS"
    )
    output: Path = option(
        Path("runs/tune"), "folder of the results and of tuned.yaml", type=Path, metavar="FOLDER"
    )

    def run(self) -> int:
        from laboratory.campaign import Workers
        from laboratory.scenario.seeds import parse_seeds
        from laboratory.search.tuning import TUNED, Tuning, parameter_file_text, read_space
        from planar import SettingsError, write_atomically
        from supervision.interruption import raise_when_interrupted

        if not self.prove:
            raise SettingsError("--prove is missing: name the suites on which the gain is tested")
        seeds, proof_seeds = parse_seeds(self.seeds), parse_seeds(self.proof_seeds)
        tuned_on, proved_on = self._scenarios(self.suites), self._scenarios(self.prove)
        candidates = {each.digest() for each in tuned_on} & {each.digest() for each in proved_on}
        if candidates and set(seeds) & set(proof_seeds):
            raise SettingsError("--proof-seeds must differ from --seeds: both contain the same scenario")
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
        """Compare tuned with default parameters; return 0 if some scenario is better and none worse."""
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
        print("gain proved" if is_proved else "no gain proved")
        return 0 if is_proved else 1
