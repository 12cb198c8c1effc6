"""Options of every run that simulates, is shown in a window and leaves a run folder."""

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from supervision.command_line import number, option

MAX_SPEED = 1000.0


def speed_factor(text: str) -> float:
    """Convert an argument to simulated seconds per second of wall time; 0: as fast as possible."""
    speed = number(text)
    if not 0.0 <= speed <= MAX_SPEED:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 and {MAX_SPEED:g}")
    return speed


@dataclass(frozen=True)
class ViewOptions:
    """Speed, views and run folder."""

    speed: Optional[float] = option(
        None,
        "1 real time, N times that, 0 as fast as the nodes keep up "
        "(default: 1 if a person watches or Ctrl-C ends it, else 0)",
        type=speed_factor,
    )
    rviz: bool = option(False, "show it in rviz, if there is a display")
    web: bool = option(
        False,
        "show it in the browser: prints the URL of the page (docs/how_to/watch_in_the_browser.md)",
    )
    web_port: Optional[str] = option(
        None,
        "address of that page (default: a free port of 127.0.0.1); implies --web",
        metavar="[ADDRESS:]PORT",
    )
    output: Path = option(
        Path("runs"), "folder in which the run folder is created", type=Path, metavar="FOLDER"
    )

    @property
    def is_interactive(self) -> bool:
        """Whether Ctrl-C is the intended end of the run."""
        return False

    @property
    def effective_speed(self) -> float:
        """Simulated seconds per second of wall time; 0: as fast as the nodes keep up."""
        return float(self.has_view or self.is_interactive) if self.speed is None else self.speed

    @property
    def has_view(self) -> bool:
        """Whether the run is shown in rviz or in the browser."""
        return self.rviz or self.shows_cockpit

    @property
    def shows_cockpit(self) -> bool:
        """Whether the run is shown in the browser."""
        return self.web or self.web_port is not None
