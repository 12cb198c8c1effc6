from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Tuple

from supervision.command_line import argument, count, option


@dataclass(frozen=True)
class Evaluate:
    """Evaluate planners on scenarios with many seeds, on all cores, and report statistics."""

    suites: Tuple[str, ...] = argument(
        "scenario files, folders of them, or names in scenarios/", nargs="+", metavar="SUITE"
    )
    seeds: Optional[str] = option(None, "such as 0-999 (default: those of the scenario)", metavar="SEEDS")
    planner: Optional[Tuple[str, ...]] = option(
        None,
        "run with each of these local planners; official needs --over ros (default: the scenario's)",
        nargs="+",
        metavar="NAME",
    )
    workers: Optional[int] = option(None, "processes (default: one for each core)", type=count)
    scheduler: str = option(
        "", "Dask scheduler whose workers are used instead: tcp://HOST:8786", metavar="ADDRESS"
    )
    require: Optional[Tuple[str, ...]] = option(
        None, 'exit code 1 unless every scenario satisfies it: "success >= 0.99"', nargs="+", metavar="RULE"
    )
    against: Optional[str] = option(
        None,
        "exit code 1 if a scenario is worse than with this version on the same seeds",
        metavar="VERSION",
    )
    over: str = option(
        "process", "run each scenario in one process, or as a graph of ROS nodes", choices=("process", "ros")
    )
    output: Path = option(Path("runs/laboratory"), "folder of the results, tables and report", type=Path)

    def run(self) -> int:
        from laboratory.campaign import Workers
        from laboratory.evaluation import Evaluation
        from laboratory.report import regressions, violated_requirements
        from laboratory.scenario.seeds import parse_seeds
        from laboratory.statistics.requirement import parse_requirement
        from laboratory.suites import load_suites
        from planar import PlanarError, SettingsError
        from supervision.display import print_error
        from supervision.interruption import RunInterruptedError, raise_when_interrupted

        requirements = [parse_requirement(text) for text in self.require or ()]
        seeds = None if self.seeds is None else parse_seeds(self.seeds)
        scenarios, errors = load_suites(self.suites, self.planner or (), self.over == "ros")
        for complaint in errors:
            print_error(complaint)
        if not scenarios:
            raise SettingsError("no scenario can be run")
        evaluation = Evaluation(scenarios, seeds, self.output / "results.sqlite")
        earlier = evaluation.evaluated(evaluation.version_with_prefix(self.against)) if self.against else []
        raise_when_interrupted()
        with closing(evaluation):
            try:
                evaluation.run(Workers(self.workers or 0, self.scheduler))
            except (PlanarError, RunInterruptedError):
                with suppress(PlanarError):  # report the first error, even if writing the tables fails too
                    evaluated = evaluation.evaluated()
                    if any(each.results for each in evaluated):
                        self._report(evaluated)
                raise
            evaluated = evaluation.evaluated()
            self._report(evaluated)
        violated = violated_requirements(evaluated, requirements) + regressions(evaluated, earlier)
        for text in violated:
            print(text)
        return 2 if errors else int(bool(violated))

    def _report(self, evaluated: Any) -> None:
        """Write the results to the terminal, the tables and the page."""
        from laboratory.page import page_html
        from laboratory.report import summary_lines
        from laboratory.results.export import export
        from laboratory.results.version import version
        from planar import write_atomically

        print("\n".join(summary_lines(evaluated)))
        export([(each.scenario, each.results) for each in evaluated], self.output)
        write_atomically(self.output / "page.html", page_html(evaluated, version()).encode("utf-8"))
        print(f"page and tables in {self.output}")
