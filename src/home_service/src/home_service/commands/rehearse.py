from dataclasses import dataclass
from pathlib import Path
from typing import List, Optional

from evaluation.options import MissionOptions
from supervision.command_line import count, option, seconds


@dataclass(frozen=True)
class Rehearse(MissionOptions):
    """Run the home-service mission in one process, without ROS: fast and repeatable.

    The same simulation, localization, navigation and mission as in the nodes, many times faster than real
    time, and repeatable bit for bit for a seed. Prints a line for each run and a verdict.

    Exit code: 0 success, 1 failure, 2 invalid input, 130 interrupted.
    """

    runs: int = option(1, "number of runs, each with the next seed", type=count)
    faults: Optional[Path] = option(
        None,
        "YAML with a list of faults (docs/reference/faults.md; default: that of the mission)",
        type=Path,
    )
    each_fault: Optional[Path] = option(
        None,
        "compare each kind of fault with a run without it instead; writes a report to FILE",
        type=Path,
    )
    timeout: float = option(600.0, "a run fails after N simulated seconds", type=seconds)

    def run(self) -> int:
        return self._run_episodes() if self.each_fault is None else self._compare(self.each_fault)

    def _compare(self, table: Path) -> int:
        """Compare each kind of fault; return 1 after a false verdict or a needless failure."""
        from headless_mission.fault_comparison import FaultComparison, FaultComparisonRow, fault_report
        from headless_mission.inputs import read_mission
        from planar import write_atomically
        from sim_bridge.faults import KINDS

        seeds = range(self.seed, self.seed + self.runs)
        comparison = FaultComparison(
            read_mission(self), self.mission is None, self.planner, seeds, self.timeout
        )
        rows: List[FaultComparisonRow] = []
        for name in KINDS:
            rows.append(comparison.compare(name))
            print(rows[-1].line, flush=True)
            write_atomically(table, fault_report(rows, seeds, self.timeout).encode("utf-8"))
        return int(any(row.false_verdicts or row.fails_needlessly for row in rows))

    def _run_episodes(self) -> int:
        from headless_mission import EpisodeConditions, HeadlessMission, parcel_for
        from headless_mission.inputs import read_mission
        from move_base_lite.navigator.zones import Zones, load_zones
        from sim_bridge.faults import load_faults

        home, successes = read_mission(self), 0
        faulty, limits = self.faults or self.mission, self.navigation_zones
        conditions = EpisodeConditions(
            self.planner,
            faults=() if faulty is None else load_faults(faulty),
            zones=(Zones() if limits is None else load_zones(limits)).with_dock(self.dock_in_world()),
        )
        stage = (home.world, home.robot, home.grid, home.mission)
        for seed in range(self.seed, self.seed + self.runs):
            parcel = None if self.mission else parcel_for(home.mission)
            mission = HeadlessMission(
                *stage, seed=seed, parcel=parcel, conditions=conditions, semantic_map=home.semantic_map
            )
            run = mission.run(self.timeout)
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
                print(f"  implausible sensor: {run.diagnosis}", flush=True)
        print(f"{successes} of {self.runs} succeeded")
        return 0 if successes == self.runs else 1
