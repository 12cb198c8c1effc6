from dataclasses import dataclass
from pathlib import Path
from typing import List, Optional

from home_service.options import MissionOptions, count, seconds
from supervision.command_line import option


@dataclass(frozen=True)
class Faults(MissionOptions):
    """Plays the mission with each kind of fault beside its clean twin, in one process."""

    runs: int = option(1, "how many seeds, each with its clean twin", type=count)
    start: float = option(8.0, "simulated seconds after which a fault begins", type=seconds)
    timeout: float = option(400.0, "simulated seconds a run may take", type=seconds)
    kinds: str = option("", "only these kinds, by spaces")
    write: Optional[Path] = option(None, "a page to write the table to", type=Path, metavar="FILE")

    def run(self) -> int:
        from home_service.rehearsal.twins import Twins, page
        from home_service.stage import read_mission
        from planar import SettingsError, write_atomically
        from sim_bridge.faults import KINDS

        chosen: List[str] = self.kinds.split() or list(KINDS)
        unknown = [name for name in chosen if name not in KINDS]
        if unknown:
            raise SettingsError(f"--kinds: no kind named {unknown[0]}; there are {', '.join(KINDS)}")
        seeds = range(self.seed, self.seed + self.runs)
        twins = Twins(read_mission(self), self.mission is None, seeds, self.timeout)
        rows = []
        for name in chosen:
            rows.append(twins.compare(name, self.start))
            print(rows[-1].line, flush=True)
        if self.write is not None:
            write_atomically(self.write, page(rows, self.start, len(seeds)).encode("utf-8"))
        wrong = [row for row in rows if row.false_verdicts or row.is_needless_failure]
        return 1 if wrong else 0
