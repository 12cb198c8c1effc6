"""Command line options of run_project."""

import argparse
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Optional, Sequence, Tuple

from planar.errors import SettingsError
from run_project.judging.run_record import FINAL_STATUSES
from sim_bridge.rest.rules import FORMS, parse_rules
from supervision import command_line
from supervision.command_line import argument, option, seconds
from supervision.view_options import ViewOptions


def _goal_statuses(text: str) -> Tuple[str, ...]:
    endings = tuple(text.replace(",", " ").split())
    wrong = [ending for ending in endings if ending not in FINAL_STATUSES]
    if wrong or not endings:
        raise argparse.ArgumentTypeError(
            f"must be a list of {', '.join(sorted(FINAL_STATUSES))}, one for each goal, got {text!r}"
        )
    return endings


def _window_input(text: str) -> str:
    if not text.partition("=")[0] or "=" not in text or "\n" in text:
        raise argparse.ArgumentTypeError(f"must be WINDOW=TEXT, got {text!r}")
    return text


def _pace_rule(text: str) -> str:
    try:
        parse_rules(text)
    except SettingsError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return text


@dataclass(frozen=True)
class ProjectOptions(ViewOptions):
    """Run an existing home-service project, unmodified and headless.

    The project is one for the TurtleBot 2, Kinetic and Gazebo 7. Works on a copy, with stand-ins for xterm,
    Gazebo and rviz; the checkout is only read. Prints goals and markers as they happen, then a verdict;
    result.json and a log of each window are in the run folder. More in docs/how_to/run_a_project.md.

    [-- ARGUMENT...] at the end of the command line are the arguments of the script.

    Exit code: 0 all goals reached, 1 failure, 2 invalid input, 130 interrupted.

    Attributes:
        script_arguments: Arguments after ``--``, passed to the script.
    """

    path: Path = argument(
        "the checkout: a workspace, the content of src, or one package",
        default=Path(),
        metavar="PATH",
        type=Path,
    )
    script: Optional[str] = argument(
        "script, launch file or 'roslaunch ...' to run (default: home_service.sh), or go_chase_it, "
        "where_am_i, map_my_world",
        default=None,
        metavar="SCRIPT",
        nargs="?",
    )
    seed: int = option(0, "seed of all noise", type=int)
    timeout: float = option(600.0, "the run fails after N seconds of wall time", type=seconds)
    expect: Optional[Tuple[str, ...]] = option(
        None,
        "expected ends of its goals, such as aborted,succeeded",
        type=_goal_statuses,
        metavar="LIST",
    )
    type: Tuple[str, ...] = option(
        (),
        "input for windows whose programs wait for it, such as add_markers=0",
        type=_window_input,
        nargs="+",
        metavar="WINDOW=TEXT",
    )
    pace: Tuple[str, ...] = option(
        (),
        f"how time passes beside a node: {FORMS} (default: that of known nodes, or learned)",
        type=_pace_rule,
        nargs="+",
        metavar="NODE:RULE",
    )
    rviz: bool = option(False, "show it in rviz with the project's configuration")
    record: bool = option(False, "record a bag into the run folder")
    build_only: bool = option(False, "stop after the build")
    script_arguments: Tuple[str, ...] = ()


def parse(words: Sequence[str]) -> ProjectOptions:
    """Parse the command line; --help and invalid options end the process."""
    end = words.index("--") if "--" in words else len(words)
    options = command_line.parse(ProjectOptions, words[:end], "run_project.sh", allow_abbreviations=False)
    return replace(options, script_arguments=tuple(words[end + 1 :]))
