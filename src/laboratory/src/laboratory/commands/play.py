from dataclasses import dataclass

from home_service.options import seed
from supervision.command_line import argument, option


@dataclass(frozen=True)
class Play:
    """Plays one scenario with one seed, in one process, and says how it went."""

    scenario: str = argument("file of a scenario, or its name in scenarios/", metavar="SCENARIO")
    seed: int = option(0, "of all chance", type=seed)
    planner: str = option("", "local planner (default: that of the scenario)", metavar="NAME")

    def run(self) -> int:
        from laboratory.playing import play
        from laboratory.suites import one_scenario

        scenario = one_scenario(self.scenario, self.planner)
        result = play(scenario, self.seed)
        print(f"{scenario.label}, seed {self.seed}: {result.outcome.upper()}: {result.reason}")
        if result.seconds is not None:
            print(
                f"  {result.seconds:.1f} s simulated, {result.driven:.1f} m driven, trajectory {result.hash}"
            )
        return 0 if result.is_success else 1
