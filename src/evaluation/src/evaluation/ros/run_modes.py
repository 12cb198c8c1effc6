"""Ways to run a graph: until everything expected was observed, or until Ctrl-C."""

import math
import os
from typing import Mapping, Set

from evaluation.consumers.referee import Referee
from evaluation.consumers.run_recorder import RunRecorder
from evaluation.options import LaunchPlan, RunOptions
from evaluation.ros.run import Run
from evaluation.verdict import Verdict
from planar.maps.places import NamedPlace
from supervision.display import Display
from supervision.interruption import RunInterruptedError


def run_to_completion(
    options: RunOptions,
    launch: LaunchPlan,
    places: Mapping[str, NamedPlace],
    expected: Set[str],
    seconds: float = math.inf,
) -> int:
    """Run a graph until its work is done.

    Args:
        options: Options of the command.
        launch: What to launch.
        places: Places by name.
        expected: What must be observed (evaluation.verdict).
        seconds: Simulated time limit [s].

    Returns:
        Exit code.
    """
    display = Display()
    referee = Referee(places, display.print)
    with Run(options, launch, referee, RunRecorder(places), display) as run:
        failure = run.watch(lambda: referee.has_seen(expected) or referee.simulated_seconds > seconds)
        if failure is None and not referee.has_seen(expected):
            failure = f"not done within {seconds:g} simulated seconds"
        return run.conclude(referee.verdict(expected, failure))


def run_until_interrupted(
    options: RunOptions,
    launch: LaunchPlan,
    hint: str,
    places: Mapping[str, NamedPlace] = {},
    idle_text: str = "",
) -> int:
    """Run a graph for interactive use until Ctrl-C, and print where its master is.

    Args:
        options: Options of the command.
        launch: What to launch.
        hint: Line that is printed once the graph is up.
        places: Places by name.
        idle_text: State in words while no mission is under way; empty: the last state.

    Returns:
        Exit code; Ctrl-C is a success once the graph is up.
    """
    display = Display()
    referee = Referee(places, display.print, logs_goals=True, idle_text=idle_text)
    with Run(options, launch, referee, RunRecorder(places), display) as run:
        display.print(f"ROS_MASTER_URI={os.environ['ROS_MASTER_URI']}")
        try:
            display.print(hint)
            verdict = Verdict(False, run.watch(lambda: False) or "")
        except RunInterruptedError:
            verdict = Verdict(True, "ended by Ctrl-C")
        return run.conclude(verdict)
