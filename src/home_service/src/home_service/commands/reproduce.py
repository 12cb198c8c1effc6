from dataclasses import dataclass
from pathlib import Path

from supervision.command_line import argument


@dataclass(frozen=True)
class Reproduce:
    """Runs again what has left a run folder, and says whether it was the same."""

    folder: Path = argument("run folder", type=Path, metavar="RUN")

    def run(self) -> int:
        from home_service.reproducing import reproduce

        return reproduce(self.folder)
