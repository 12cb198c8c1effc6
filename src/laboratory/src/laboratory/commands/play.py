from dataclasses import dataclass
from typing import Any

from evaluation.options import RunOptions
from supervision.command_line import argument, option, seed, words


@dataclass(frozen=True)
class Play(RunOptions):
    """Run one scenario with one seed, and print the result, the same bit for bit as in evaluate.sh.

    Runs in one process without ROS by default. With --over ros the graph of nodes runs it, as
    home_service.sh runs a mission, with a run folder; only then the options for speed, views, animation,
    time limit and folder have an effect.

    Exit code: 0 success, 1 failure, 2 invalid input, 130 interrupted.
    """

    scenario: str = argument(
        "scenario file (docs/reference/scenarios.md), or its name in scenarios/",
        default="",
        metavar="SCENARIO",
    )
    seed: int = option(0, "seed of all random numbers", type=seed)
    planner: str = option(
        "", "local planner (default: that of the scenario); over ROS also official", metavar="NAME"
    )
    localizer: str = option(
        "", "official: the official amcl, over ROS (default: amcl_lite)", choices=("official",)
    )
    over: str = option(
        "process", "how it is run: in one process, or as the graph of ROS nodes", choices=("process", "ros")
    )

    def run(self) -> int:
        from evaluation.preload import preload_nodes
        from laboratory.suites import load_scenario

        if self.over == "ros":
            preload_nodes()
        scenario = load_scenario(self.scenario, self.planner, self.over == "ros", self.localizer)
        if self.over == "ros":
            from laboratory.ros.scenario_launch import launch_scenario

            return launch_scenario(self, scenario, self.seed)
        self._refuse_ros_options()
        return self._run_in_process(scenario)

    def _run_in_process(self, scenario: Any) -> int:
        from laboratory.runner import run_scenario

        result = run_scenario(scenario, self.seed)
        print(f"{scenario.label}, seed {self.seed}: {result.outcome.upper()}: {result.reason}")
        if result.seconds is not None:
            print(
                f"  {result.seconds:.1f} s simulated, {result.driven:.1f} m driven, trajectory {result.hash}"
            )
        return 0 if result.is_success else 1

    def _refuse_ros_options(self) -> None:
        from planar import SettingsError

        defaults = words(Play(scenario=self.scenario, seed=self.seed, planner=self.planner))
        given = [word for word in words(self) if word not in defaults and word.startswith("--")]
        if given:
            raise SettingsError(f"{given[0]} applies only to runs over ROS; add --over ros")
