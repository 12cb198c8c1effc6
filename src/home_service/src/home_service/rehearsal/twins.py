"""Runs with a fault beside the same runs without it."""

from dataclasses import dataclass
from typing import Dict, Sequence

from home_service.judging.verdict import collision
from home_service.rehearsal.rehearsal import Conditions, Rehearsal, Rehearsed, parcel_of
from home_service.stage import MissionHome
from sim_bridge.faults import KINDS, Fault, default_strength

# Simulated seconds: on the way to the object.
START = 8.0
HEAD = """# Faults

What becomes of the errand when something goes wrong {start:g} s after the start and stays so: each kind of
fault beside its clean twin of the same seed, in one process, over {seeds}. Made by
`./scripts/rehearse.sh --seed {seed} --runs {runs} --timeout {timeout:g} --each-fault docs/reports/faults.md`.

A verdict is false if the robot says that it has delivered and has not, or the other way round. *Lost* is the
simulated time beyond the clean twin's. *Named* is the sensor that the robot did not trust, and why.
Where 0.0 s are lost to a thing in the way, it did not stand in the way of what came after.

| fault | what goes wrong | strength | succeeded | touched | false verdicts | lost, s | named, or the end |
| --- | --- | --- | --- | --- | --- | --- | --- |
"""
TAIL = """
Every key of a fault, and how to add a kind: [faults](../reference/faults.md).
"""


@dataclass(frozen=True)
class Row:
    """What a kind of fault does to the mission, over all seeds."""

    kind: str
    runs: int
    successes: int
    touches: str
    false_verdicts: int
    seconds_lost: float
    ending: str

    @property
    def is_needless_failure(self) -> bool:
        """Whether most runs failed that need not have."""
        return KINDS[self.kind].survivable and 2 * self.successes < self.runs

    @property
    def line(self) -> str:
        """For the terminal."""
        told = f"{self.kind}: {self.successes} of {self.runs} succeeded, {self.seconds_lost:.1f} s lost"
        return ", ".join(filter(None, (told, self.touches, self.ending)))

    @property
    def table_line(self) -> str:
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


class Twins:
    """Plays a mission with a fault and without, for each of ``seeds``."""

    def __init__(
        self, home: MissionHome, is_errand: bool, planner: str, seeds: Sequence[int], timeout: float
    ):
        self._home, self._is_errand, self._planner = home, is_errand, planner
        self._seeds, self._timeout = seeds, timeout
        self._clean: Dict[int, Rehearsed] = {}

    def compare(self, kind: str) -> Row:
        """What the kind of fault does."""
        fault = Fault(kind, START, strength=default_strength(kind))
        pairs = [(self._twin(seed), self._play(seed, (fault,))) for seed in self._seeds]
        won = [(clean, run) for clean, run in pairs if run.verdict.success]
        lost = sum(run.simulated_seconds - clean.simulated_seconds for clean, run in won)
        touched = [name for _, run in pairs for name in run.ledger.collisions]
        endings = [run.diagnosis or ("" if run.verdict.success else run.verdict.reason) for _, run in pairs]
        return Row(
            kind,
            len(pairs),
            len(won),
            collision(touched) or "",
            sum(map(_is_false, (run for _, run in pairs))),
            lost / len(won) if won else 0.0,
            next(filter(None, endings), ""),
        )

    def _twin(self, seed: int) -> Rehearsed:
        if seed not in self._clean:
            self._clean[seed] = self._play(seed, ())
        return self._clean[seed]

    def _play(self, seed: int, faults: Sequence[Fault]) -> Rehearsed:
        home = self._home
        parcel = parcel_of(home.mission) if self._is_errand else None
        stage = (home.world, home.robot, home.grid, home.mission)
        rehearsal = Rehearsal(
            *stage, seed=seed, parcel=parcel, conditions=Conditions(self._planner, faults=faults)
        )
        return rehearsal.run(self._timeout)


def page(rows: Sequence[Row], seeds: Sequence[int], timeout: float) -> str:
    """The table, as a page of the documentation; how it was made: ``seeds`` in a row, simulated seconds."""
    runs = len(seeds)
    told = "one seed" if runs == 1 else f"{runs} seeds"
    head = HEAD.format(start=START, seeds=told, seed=seeds[0], runs=runs, timeout=timeout)
    return head + "".join(row.table_line for row in rows) + TAIL


def _is_false(run: Rehearsed) -> bool:
    """Whether the robot said something of its mission that is not so."""
    records = run.ledger.deliveries
    is_delivered = bool(records) and all(record.complaint is None for record in records)
    return (run.ledger.final_state == "delivered") != is_delivered
