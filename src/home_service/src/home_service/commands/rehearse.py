from dataclasses import dataclass
from pathlib import Path
from typing import List, Optional

from home_service.options import MissionOptions, count, seconds
from supervision.command_line import option


@dataclass(frozen=True)
class Rehearse(MissionOptions):
    """Plays the home-service mission in one process, without ROS: fast and repeatable."""

    runs: int = option(1, "how many runs, each with the next seed", type=count)
    faults: Optional[Path] = option(
        None, "YAML with a list of faults; default: those of the mission", type=Path, metavar="FILE"
    )
    each_fault: Optional[Path] = option(
        None,
        "play with each kind of fault beside a clean twin instead, and write the table to this page",
        type=Path,
        metavar="FILE",
    )
    timeout: float = option(600.0, "simulated seconds a run may take", type=seconds)

    def run(self) -> int:
        return self._rehearse() if self.each_fault is None else self._compare(self.each_fault)

    def _compare(self, table: Path) -> int:
        """With each kind of fault; 1 if a verdict was false, or most runs failed that need not have."""
        from home_service.rehearsal.twins import Row, Twins, page
        from home_service.stage import read_mission
        from planar import write_atomically
        from sim_bridge.faults import KINDS

        seeds = range(self.seed, self.seed + self.runs)
        twins = Twins(read_mission(self), self.mission is None, self.planner, seeds, self.timeout)
        rows: List[Row] = []
        for name in KINDS:
            rows.append(twins.compare(name))
            print(rows[-1].line, flush=True)
            write_atomically(table, page(rows, seeds, self.timeout).encode("utf-8"))
        return int(any(row.false_verdicts or row.is_needless_failure for row in rows))

    def _rehearse(self) -> int:
        from home_service.rehearsal import Conditions, Rehearsal, parcel_of
        from home_service.stage import read_mission
        from sim_bridge.faults import load_faults

        home, successes = read_mission(self), 0
        faulty = self.faults or self.mission
        conditions = Conditions(self.planner, faults=() if faulty is None else load_faults(faulty))
        stage = (home.world, home.robot, home.grid, home.mission)
        for seed in range(self.seed, self.seed + self.runs):
            parcel = None if self.mission else parcel_of(home.mission)
            rehearsal = Rehearsal(*stage, seed=seed, parcel=parcel, conditions=conditions)
            run = rehearsal.run(self.timeout)
            successes += run.verdict.success
            print(f"seed {seed}: {'SUCCESS' if run.verdict.success else 'FAILURE'}: {run.verdict.reason}")
            print(
                f"  {run.simulated_seconds:.1f} s simulated, {run.real_time_factor:.1f} x real time, "
                f"{run.distance_driven:.1f} m driven, "
                f"localization off by {run.localization_error.mean():.3f} m (mean), "
                f"trajectory {run.trajectory_hash[:16]}",
                flush=True,
            )
            if run.diagnosis:
                print(f"  not trusted: {run.diagnosis}", flush=True)
        print(f"{successes} of {self.runs} succeeded")
        return 0 if successes == self.runs else 1
