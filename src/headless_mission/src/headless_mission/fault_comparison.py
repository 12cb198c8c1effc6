"""Episodes with a fault, each paired with the baseline of the same seed."""

from dataclasses import dataclass
from datetime import date
from typing import Dict, Sequence

from evaluation.verdict import collision
from headless_mission.conditions import EpisodeConditions
from headless_mission.inputs import MissionInputs
from headless_mission.mission import HeadlessMission, parcel_for
from headless_mission.result import EpisodeResult
from sim_bridge.faults import KINDS, Fault, default_strength
from supervision.versions import provenance

# Start of the fault, while the robot drives to the object [s].
START = 8.0
HEAD = """# Faults

Look up what each kind of fault does to the home-service mission: the fault starts at {start:g} s and stays,
in one process, over {seeds}, beside a run of the same seed without it.

{provenance}
* Command: `./scripts/rehearse.sh --seed {seed} --runs {runs} --timeout {timeout:g} --each-fault
  docs/reports/faults.md`

A verdict is false if the robot reports a delivery that did not take place, or the reverse. *Lost* is the
additional simulated time. *Named* is the sensor that navigation did not trust, with the reason. Where an
obstacle costs 0.0 s, it was not in the way.

| fault | what goes wrong | strength | succeeded | touched | false verdicts | lost, s | named, or the end |
| --- | --- | --- | --- | --- | --- | --- | --- |
"""
TAIL = """
Every key of a fault, and how to add a kind: [faults](../reference/faults.md).
"""


@dataclass(frozen=True)
class FaultComparisonRow:
    """Effect of a kind of fault on the mission, over all seeds.

    Attributes:
        kind: Kind of fault.
        runs: Number of episodes.
        successes: Successful ones.
        touches: What was collided with, in words.
        false_verdicts: Episodes in which the robot reported a false outcome.
        seconds_lost: Mean simulated time beyond the baseline, of successful episodes [s].
        ending: First diagnosis, or reason of a failure.
    """

    kind: str
    runs: int
    successes: int
    touches: str
    false_verdicts: int
    seconds_lost: float
    ending: str

    @property
    def fails_needlessly(self) -> bool:
        """Whether most episodes failed although the fault is survivable."""
        return KINDS[self.kind].survivable and 2 * self.successes < self.runs

    @property
    def line(self) -> str:
        """Line for the terminal."""
        summary = f"{self.kind}: {self.successes} of {self.runs} succeeded, {self.seconds_lost:.1f} s lost"
        return ", ".join(filter(None, (summary, self.touches, self.ending)))

    @property
    def table_row(self) -> str:
        """Row of the Markdown table."""
        kind = KINDS[self.kind]
        what = (kind.__doc__ or "").partition("\n")[0].rstrip(".")
        strength = f"{kind.strength[0]:g} {kind.unit}" if kind.unit else ""
        cells = (
            f"`{self.kind}`",
            what,
            strength,
            f"{self.successes} of {self.runs}",
            self.touches,
            str(self.false_verdicts),
            f"{self.seconds_lost:.1f}" if self.successes else "",
            self.ending,
        )
        return f"| {' | '.join(cells)} |\n"


class FaultComparison:
    """Runs a mission with and without a fault for each seed.

    Args:
        home: Mission and its world.
        is_errand: The mission is the errand between the zones, whose marker is judged, too.
        planner: Local planner; empty: the preset's.
        seeds: Seeds of the episodes.
        timeout: Simulated time limit of an episode [s].
    """

    def __init__(
        self, home: MissionInputs, is_errand: bool, planner: str, seeds: Sequence[int], timeout: float
    ):
        self._home, self._is_errand, self._planner = home, is_errand, planner
        self._seeds, self._timeout = seeds, timeout
        self._baselines: Dict[int, EpisodeResult] = {}

    def compare(self, kind: str) -> FaultComparisonRow:
        """Return the effect of a kind of fault."""
        fault = Fault(kind, START, strength=default_strength(kind))
        pairs = [(self._baseline(seed), self._run_episode(seed, (fault,))) for seed in self._seeds]
        won = [(baseline, run) for baseline, run in pairs if run.verdict.success]
        lost = sum(run.simulated_seconds - baseline.simulated_seconds for baseline, run in won)
        touched = [name for _, run in pairs for name in run.mission_record.collisions]
        endings = [run.diagnosis or ("" if run.verdict.success else run.verdict.reason) for _, run in pairs]
        return FaultComparisonRow(
            kind,
            len(pairs),
            len(won),
            collision(touched) or "",
            sum(map(_is_false, (run for _, run in pairs))),
            lost / len(won) if won else 0.0,
            next(filter(None, endings), ""),
        )

    def _baseline(self, seed: int) -> EpisodeResult:
        if seed not in self._baselines:
            self._baselines[seed] = self._run_episode(seed, ())
        return self._baselines[seed]

    def _run_episode(self, seed: int, faults: Sequence[Fault]) -> EpisodeResult:
        home = self._home
        parcel = parcel_for(home.mission) if self._is_errand else None
        stage = (home.world, home.robot, home.grid, home.mission)
        mission = HeadlessMission(
            *stage, seed=seed, parcel=parcel, conditions=EpisodeConditions(self._planner, faults=faults)
        )
        return mission.run(self._timeout)


def fault_report(rows: Sequence[FaultComparisonRow], seeds: Sequence[int], timeout: float) -> str:
    """Return the page of the documentation with the table.

    Args:
        rows: Rows of the table.
        seeds: Consecutive seeds.
        timeout: Simulated time limit of an episode [s].
    """
    runs = len(seeds)
    seed_count = "one seed" if runs == 1 else f"{runs} seeds"
    head = HEAD.format(
        start=START,
        seeds=seed_count,
        seed=seeds[0],
        runs=runs,
        timeout=timeout,
        provenance=provenance(date.today()),
    )
    return head + "".join(row.table_row for row in rows) + TAIL


def _is_false(run: EpisodeResult) -> bool:
    """Whether the robot reported an outcome of its mission that is not true."""
    records = run.mission_record.deliveries
    is_delivered = bool(records) and all(record.failure is None for record in records)
    return (run.mission_record.final_state == "delivered") != is_delivered
