"""Command line options of run_project."""

import argparse
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Optional, Sequence, Tuple

from run_project.judging.run_record import FINAL_STATUSES
from supervision import command_line
from supervision.command_line import argument, option


def _speed(text: str) -> float:
    value = float(text)
    if not (math.isfinite(value) and value >= 0.0):
        raise argparse.ArgumentTypeError(f"must be 0 or more, got {text}")
    return value


def _seconds(text: str) -> float:
    value = float(text)
    if not (math.isfinite(value) and value > 0.0):
        raise argparse.ArgumentTypeError(f"must be positive, got {text}")
    return value


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


@dataclass(frozen=True)
class ProjectOptions:
    """Run an existing home-service project, unmodified and headless.

    Attributes:
        script_arguments: Arguments after ``--``, passed to the script.
    """

    path: Path = argument("the project's checkout", metavar="PATH", type=Path)
    script: Optional[str] = argument(
        "script to run (default: home_service.sh), or go_chase_it, where_am_i, map_my_world",
        default=None,
        metavar="SCRIPT",
        nargs="?",
    )
    speed: Optional[float] = option(
        None, "1: real time, N: N times real time, 0: as fast as the nodes keep up", type=_speed
    )
    seed: int = option(0, "seed of all noise", type=int)
    timeout: float = option(600.0, "time limit in seconds of wall time", type=_seconds)
    expect: Optional[Tuple[str, ...]] = option(
        None, "expected final status of each goal, as aborted,succeeded", type=_goal_statuses
    )
    type: Tuple[str, ...] = option(
        (),
        "input for programs that read from their terminal, as add_markers=0",
        type=_window_input,
        nargs="+",
        metavar="WINDOW=TEXT",
    )
    rviz: bool = option(False, "show the run in rviz")
    web: bool = option(False, "show the run in the browser: prints the URL of the cockpit")
    web_port: Optional[str] = option(None, "address of the cockpit", metavar="[ADDRESS:]PORT")
    record: bool = option(False, "record a bag into the run folder")
    build_only: bool = option(False, "build only, do not run")
    output: Path = option(Path("runs"), "folder in which the run folder is created", type=Path)
    script_arguments: Tuple[str, ...] = ()

    @property
    def effective_speed(self) -> float:
        """Simulated seconds per second of wall time; 0: as fast as the nodes keep up.

        Defaults to real time with ``--rviz`` or ``--web``.
        """
        return float(self.rviz or self.shows_cockpit) if self.speed is None else self.speed

    @property
    def shows_cockpit(self) -> bool:
        return self.web or self.web_port is not None


def parse(words: Sequence[str]) -> ProjectOptions:
    """Parse the command line; --help and invalid options end the process."""
    end = words.index("--") if "--" in words else len(words)
    options = command_line.parse(ProjectOptions, words[:end], "run_project.sh", allow_abbreviations=False)
    return replace(options, script_arguments=tuple(words[end + 1 :]))
