from dataclasses import dataclass
from pathlib import Path

from supervision.command_line import argument


@dataclass(frozen=True)
class Reproduce:
    """Run the command of a run folder again, and compare every bit.

    World, parameters and seed are the same. Prints the first message that differs, with its node and time;
    the new run is in RUN/again. What makes runs repeatable: docs/explanation/deterministic_runs.md.

    Exit code: 0 the same, 1 not the same, 2 invalid input, 130 interrupted.
    """

    folder: Path = argument("run folder", type=Path, metavar="RUN")

    def run(self) -> int:
        from home_service.reproducing import reproduce

        return reproduce(self.folder)
