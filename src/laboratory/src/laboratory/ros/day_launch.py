"""Run a day of service as a graph of ROS nodes."""

import tempfile
from dataclasses import replace
from pathlib import Path

from evaluation.consumers.referee import Referee
from evaluation.consumers.run_recorder import RunRecorder
from evaluation.options import LaunchPlan, RunOptions
from evaluation.ros.run import Run
from evaluation.verdict import Verdict
from laboratory.launch_files import write_launch_files
from laboratory.scenario import Scenario
from laboratory.tasks.service_day import ServiceDayTask, trace_of
from laboratory.tasks.task import SUCCESS
from planar.maps.places import load_places
from service.day.day_recorder import DayRecorder
from service.day.preparation import MIDNIGHT
from service.requests.timed_requests import load_requests
from supervision.display import Display


def launch_day(options: RunOptions, scenario: Scenario, task: ServiceDayTask, seed: int) -> int:
    """Run the graph until the day is over, write its page into the run folder, and return the exit code.

    Args:
        options: Options of the command; without a time limit a simulated second takes at most a second.
        scenario: The scenario.
        task: Its task.
        seed: Seed of the day.
    """
    display = Display()
    options = replace(options, timeout=options.timeout or options.time_limit + scenario.seconds)
    with tempfile.TemporaryDirectory(prefix="day-") as parent:
        arguments = write_launch_files(scenario, seed, Path(parent), task.start)
        places = load_places(arguments["zones_file"])
        requests = load_requests(arguments["requests_file"])
        referee, recorder = Referee(places, display.print), DayRecorder(MIDNIGHT, MIDNIGHT + scenario.seconds)
        launch = LaunchPlan("service_day.launch", arguments, package="laboratory", tool="service")
        with Run(options, launch, referee, RunRecorder(places), display, (recorder,)) as run:
            failure = run.watch(lambda: referee.simulated_seconds >= scenario.seconds)
            if failure is not None:
                return run.conclude(Verdict(False, failure))
            journal = Path(arguments["state_folder"], "journal.db")
            record = recorder.record(journal, requests, referee.mission_record.collisions)
            task.write_report(run.folder / "day.html", record, scenario.arena(seed), seed)
            trace = trace_of(record)
            verdict = Verdict(trace.outcome == SUCCESS, trace.reason)
            return run.conclude(verdict, outcome=trace.outcome, score=trace.score)
