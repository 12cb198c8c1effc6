#!/usr/bin/env python3
"""Run projects of other people twice, and once in another workspace; print verdicts, events and wall times.

    python3 tests/benchmarks/foreign_projects.py CHECKOUT... [--beside WORKSPACE] [--busy 2] [--json FILE]

With ``--busy``, so many busy processes run beside the second run. Two runs have the same events if goals,
markers and checks come in the same order, where events of one instant have none, and with the same texts but
for measured positions; times may differ by as much as is printed. ``--beside`` names a
workspace of another version, set up, whose wall time is the base of the ratio.
"""

import argparse
import json
import re
import subprocess
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from typing import List, Optional, Tuple

from helpers.busy_loops import busy_loops
from unsynchronised_nodes import ROOT

# Longest run [wall s].
RUN_SECONDS = 900.0
VERDICT = re.compile(r"^(SUCCESS|FAILURE): (.*)$", re.MULTILINE)
# Part of move_base's report of a failure.
POSITION = re.compile(r" from the robot at \([^)]*\)")
# An event with its simulated time; not the distance driven, which is printed by wall time, and windows.
EVENT = re.compile(r"^ *([0-9.]+) s  (?!.* driven|window )(.+)$", re.MULTILINE)
ROW = "{:40} {:8} {:8} {:8} {:>6} {:>12} {:>7} {:>7} {:>7} {:>6}"
TITLES = ("project", "first", "second", "beside", "events", "apart by", "wall s", "second", "beside", "ratio")
REASON_LENGTH = 140


@dataclass
class Run:
    """A run of a project.

    Attributes:
        verdict: SUCCESS, FAILURE or the reason for none.
        reason: Why.
        seconds: Wall time [s].
        events: Simulated times [s] and texts.
    """

    verdict: str
    reason: str
    seconds: float
    events: List[Tuple[float, str]]

    @property
    def texts(self) -> List[str]:
        """Texts in order; those of one instant by alphabet, for they come from different nodes."""
        return [POSITION.sub("", text) for _, text in sorted(self.events)]

    @property
    def times(self) -> List[float]:
        return [at for at, _ in sorted(self.events)]


def run_project(workspace: Path, checkout: Path) -> Run:
    """Run a project as its user does."""
    begun = time.monotonic()
    command = [str(workspace / "scripts/run_project.sh"), str(checkout)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=RUN_SECONDS)
    except subprocess.TimeoutExpired:
        return Run("no end", f"within {RUN_SECONDS:g} s", RUN_SECONDS, [])
    seconds = time.monotonic() - begun
    found = VERDICT.search(done.stdout)
    verdict, reason = found.groups() if found else ("no run", (done.stderr.splitlines() or [""])[-1])
    return Run(verdict, reason, seconds, [(float(at), text) for at, text in EVENT.findall(done.stdout)])


def apart(first: Run, second: Run) -> Optional[float]:
    """Longest time between the same event of two runs [simulated s]; None if they have other events."""
    if first.texts != second.texts:
        return None
    return max((abs(a - b) for a, b in zip(first.times, second.times)), default=0.0)


def print_row(checkout: Path, first: Run, second: Run, beside: Optional[Run]) -> None:
    difference = apart(first, second)
    same = "other events" if difference is None else f"{difference:.1f} s"
    ratio = f"{first.seconds / beside.seconds:.2f}" if beside else ""
    verdicts = (run.verdict if run else "" for run in (first, second, beside))
    seconds = (f"{run.seconds:.1f}" if run else "" for run in (first, second, beside))
    print(ROW.format(checkout.name[:40], *verdicts, len(first.events), same, *seconds, ratio))
    for run in filter(None, (first, second, beside)):
        print(f"    {run.reason[:REASON_LENGTH]}", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("checkouts", nargs="+", type=Path, metavar="CHECKOUT")
    parser.add_argument("--beside", type=Path, metavar="WORKSPACE")
    parser.add_argument("--busy", type=int, default=0)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    print(ROW.format(*TITLES))
    rows = []
    for checkout in options.checkouts:
        beside = run_project(options.beside, checkout) if options.beside else None
        first = run_project(ROOT, checkout)
        with busy_loops(options.busy):
            second = run_project(ROOT, checkout)
        print_row(checkout, first, second, beside)
        rows.append((checkout, first, second, beside))
    same = sum(apart(first, second) is not None for _, first, second, _ in rows)
    print(f"{same} of {len(rows)} with the same events in the same order")
    if options.beside:
        ratios = [first.seconds / beside.seconds for _, first, _, beside in rows if beside]
        print(f"median ratio of the wall times {median(ratios):.2f}")
    if options.json:
        runs = [[str(row[0]), *(each and asdict(each) for each in row[1:])] for row in rows]
        options.json.write_text(json.dumps(runs, indent=1))
    return int(same < len(rows))


if __name__ == "__main__":
    sys.exit(main())
