"""Run a scenario as a graph of ROS nodes."""

import tempfile
from pathlib import Path

from evaluation.options import LaunchPlan, RunOptions
from evaluation.ros.run_modes import run_to_completion
from evaluation.verdict import ERRAND, MARKERS, OBJECTS
from laboratory.launch_files import write_launch_files
from laboratory.ros.day_launch import launch_day
from laboratory.scenario import Scenario
from laboratory.tasks.service_day import ServiceDayTask
from pick_objects import load_mission
from planar.maps.places import load_places


def launch_scenario(options: RunOptions, scenario: Scenario, seed: int) -> int:
    """Run the graph until the mission ends; return the exit code."""
    if isinstance(scenario.task, ServiceDayTask):
        return launch_day(options, scenario, scenario.task, seed)
    with tempfile.TemporaryDirectory(prefix="scenario-") as folder:
        arguments = write_launch_files(scenario, seed, Path(folder))
        places = load_places(arguments["zones_file"])
        mission_file = arguments.get("mission_file")
        if mission_file:
            places.update(load_mission(mission_file, places).places)
        expected = {ERRAND, OBJECTS if mission_file else MARKERS}
        launch = LaunchPlan("scenario.launch", arguments, package="laboratory")
        return run_to_completion(options, launch, places, expected, scenario.seconds)
