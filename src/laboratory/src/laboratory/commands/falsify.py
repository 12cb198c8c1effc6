from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from supervision.command_line import argument, count, option, seed


@dataclass(frozen=True)
class Falsify:
    """Search for disturbances that make a scenario fail, and shrink the first failing case.

    Varies places of boxes, pedestrians and their goals, faults, noise and seeds, each case near the hardest
    so far. The minimal failing case is written as a scenario. Ctrl-C loses nothing; the next start
    continues.

    Exit code: 0 nothing found, 1 a failure found, 2 invalid input, 130 interrupted.
    """

    scenario: str = argument(
        "scenario file (docs/reference/scenarios.md), or its name in scenarios/", metavar="SCENARIO"
    )
    trials: int = option(200, "maximum number of cases", type=count)
    boxes: int = option(4, "maximum number of boxes", type=int)
    people: int = option(2, "maximum number of pedestrians", type=int)
    faults: int = option(1, "maximum number of faults", type=int)
    seed: int = option(0, "seed of the search", type=seed)
    planner: str = option("", "local planner (default: that of the scenario)", metavar="NAME")
    workers: Optional[int] = option(None, "number of processes (default: one for each core)", type=count)
    scheduler: str = option(
        "", "Dask scheduler instead of local processes: tcp://HOST:8786", metavar="ADDRESS"
    )
    output: Path = option(
        Path("runs/falsify"),
        "folder of the results and of the failing case",
        type=Path,
        metavar="FOLDER",
    )

    def run(self) -> int:
        from laboratory.campaign import Workers
        from laboratory.search.case_file import write_case
        from laboratory.search.cases import CaseSpace
        from laboratory.search.falsification import FalsificationSearch
        from laboratory.suites import load_scenario
        from planar import SettingsError
        from supervision.interruption import raise_when_interrupted

        case_space = CaseSpace(self.boxes, self.people, self.faults)
        if min(self.boxes, self.people, self.faults) < 0:
            raise SettingsError("--boxes, --people and --faults must not be negative")
        scenario = load_scenario(self.scenario, self.planner)
        raise_when_interrupted()
        search = FalsificationSearch(scenario, case_space, self.seed, self.output)
        with Workers(self.workers or 0, self.scheduler).client() as client:
            found = search.run(client, self.trials)
        if found is None:
            print(
                f"no failure found in {search.evaluated_count} cases "
                f"(minimum robustness {search.min_robustness:.2f})"
            )
            return 0
        case, result = search.shrink(found)
        path = write_case(scenario, case, result, self.output)
        print(f"{result.outcome.upper()}: {result.reason}")
        print(
            f"shrunk from {len(found.elements)} to {len(case.elements)} elements: ./scripts/play.sh {path}",
            end=" ",
        )
        print(f"--seed {case.seed}")
        return 1
