"""A scenario played by the nodes."""

import tempfile
from pathlib import Path
from typing import Optional

from home_service.judging.verdict import ERRAND, MARKERS, OBJECTS
from home_service.options import LaunchPlan, RunOptions
from home_service.ros.referee import Referee
from home_service.ros.run import Run
from home_service.ros.run_recorder import RunRecorder
from laboratory.scenario import Scenario
from laboratory.staging import stage
from pick_objects import load_mission
from planar.maps.places import load_places
from supervision.display import Display


def conduct(options: RunOptions, scenario: Scenario, seed: int) -> int:
    """Runs the graph until the task is done or cannot be any more; returns the exit code."""
    with tempfile.TemporaryDirectory(prefix="scenario-") as folder:
        arguments = stage(scenario, seed, Path(folder))
        places = load_places(arguments["zones_file"])
        mission_file = arguments.get("mission_file")
        if mission_file:
            places.update(load_mission(mission_file, places).places)
        expected = {ERRAND, OBJECTS if mission_file else MARKERS}
        launch = LaunchPlan("scenario.launch", arguments, package="laboratory")
        display = Display()
        referee = Referee(places, display.say)
        with Run(options, launch, referee, RunRecorder(places), display) as run:

            def too_long() -> Optional[str]:
                is_over = referee.simulated_seconds > scenario.seconds
                return f"not done within {scenario.seconds:g} simulated seconds" if is_over else None

            failure = run.watch(lambda: referee.has_seen(expected) or too_long() is not None)
            if not referee.has_seen(expected):
                failure = failure or too_long()
            return run.conclude(referee.verdict(expected, failure))
