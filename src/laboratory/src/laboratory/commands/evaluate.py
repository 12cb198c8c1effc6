from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Tuple

from supervision.command_line import argument, count, option


@dataclass(frozen=True)
class Evaluate:
    """Run scenarios with many seeds on all cores, without ROS, and report statistics.

    Prints success rates with intervals, times, collisions and clearance. Each result is stored at once;
    results of the same software are not computed again, so Ctrl-C loses nothing.

    Exit code: 0 success, 1 a rule is violated, 2 invalid input (the rest is run), 130 interrupted.
    """

    suites: Tuple[str, ...] = argument(
        "scenario files (docs/reference/scenarios.md), folders of them, or names in scenarios/",
        nargs="+",
        metavar="SUITE",
    )
    seeds: Optional[str] = option(
        None, "such as 0-999 or 1,5,7 (default: those of the scenario)", metavar="SEEDS"
    )
    planner: Optional[Tuple[str, ...]] = option(
        None,
        "run with each of these local planners (default: that of the scenario); over ROS also official, "
        "the official move_base with DWA",
        nargs="+",
        metavar="NAME",
    )
    localizer: str = option(
        "", "official: the official amcl, over ROS (default: amcl_lite)", choices=("official",)
    )
    workers: Optional[int] = option(None, "number of processes (default: one for each core)", type=count)
    scheduler: str = option(
        "", "Dask scheduler instead of local processes: tcp://HOST:8786", metavar="ADDRESS"
    )
    require: Optional[Tuple[str, ...]] = option(
        None, 'exit code 1 unless this holds for each scenario: "success >= 0.99"', nargs="+", metavar="RULE"
    )
    against: Optional[str] = option(
        None,
        "exit code 1 if a scenario is worse than with this version of the software, on the same seeds",
        metavar="VERSION",
    )
    over: str = option(
        "process",
        "how each is run: in one process, or as the graph of ROS nodes, a few runs a minute",
        choices=("process", "ros"),
    )
    output: Path = option(Path("runs/laboratory"), "folder of results", type=Path, metavar="FOLDER")

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
        scenarios, errors = load_suites(self.suites, self.planner or (), self.over == "ros", self.localizer)
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
