from dataclasses import dataclass
from pathlib import Path

from supervision.command_line import argument


@dataclass(frozen=True)
class Reproduce:
    """Repeat a run from its folder, and report whether it was the same."""

    folder: Path = argument("run folder", type=Path, metavar="RUN")

    def run(self) -> int:
        from home_service.reproducing import reproduce

        return reproduce(self.folder)
