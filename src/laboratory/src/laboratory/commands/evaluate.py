from dataclasses import dataclass
from pathlib import Path
from typing import Any, List, Optional, Tuple

from home_service.options import count
from supervision.command_line import argument, option


@dataclass(frozen=True)
class Evaluate:
    """Plays suites of scenarios over all cores, each seed once, and says what that proves."""

    suites: Tuple[str, ...] = argument(
        "files or folders of scenarios, or names in scenarios/", nargs="+", metavar="SUITE"
    )
    seeds: Optional[str] = option(None, "like 0-999 (default: those of the scenario)", metavar="SEEDS")
    planner: Optional[Tuple[str, ...]] = option(
        None, "with each of these local planners (default: the scenario's)", nargs="+", metavar="NAME"
    )
    workers: Optional[int] = option(None, "processes (default: one for each core)", type=count)
    scheduler: str = option("", "Dask's, instead of processes here: tcp://HOST:8786", metavar="ADDRESS")
    require: Optional[Tuple[str, ...]] = option(
        None, 'exit code 1 unless this holds of each scenario: "success >= 0.99"', nargs="+", metavar="RULE"
    )
    output: Path = option(Path("runs/laboratory"), "results are kept and told here", type=Path)

    def run(self) -> int:
        from laboratory.campaign import Workers
        from laboratory.evaluation import Evaluation
        from laboratory.results.export import export
        from laboratory.scenario.seeds import seeds_of
        from laboratory.statistics.requirement import requirement_from
        from laboratory.suites import scenarios_of
        from planar import SettingsError
        from supervision.display import complain
        from supervision.interruption import raise_when_interrupted

        rules = [requirement_from(text) for text in self.require or ()]
        seeds = None if self.seeds is None else seeds_of(self.seeds)
        scenarios, complaints = scenarios_of(self.suites, self.planner or ())
        for complaint in complaints:
            complain(complaint)
        if not scenarios:
            raise SettingsError("no scenario is left to be played")
        evaluation = Evaluation(scenarios, seeds, self.output / "results.sqlite")
        raise_when_interrupted()
        try:
            evaluation.play(Workers(self.workers or 0, self.scheduler))
        finally:
            evaluated = evaluation.evaluated()
            tell(evaluated)
            export([(each.scenario, each.results) for each in evaluated], self.output)
            evaluation.close()
        broken = broken_rules(evaluated, rules)
        for text in broken:
            print(text)
        return 2 if complaints else int(bool(broken))


def tell(evaluated: Any) -> None:
    """What came of each scenario, in the terminal."""
    for each in evaluated:
        told = each.summary
        outcomes = ", ".join(f"{number} {name}" for name, number in told.outcomes.items() if number)
        print(f"{each.scenario.label}: {told.runs} runs: {outcomes or 'none played'}")
        for name, estimate in told.figures.items():
            if name not in told.outcomes or name == "success":
                print(f"  {name:<12} {estimate}")


def broken_rules(evaluated: Any, rules: Any) -> List[str]:
    """A line for each rule that does not hold of a scenario."""
    return [
        f"{each.scenario.label}: not {rule}"
        for each in evaluated
        for rule in rules
        if not rule.is_met(each.summary.figures)
    ]
