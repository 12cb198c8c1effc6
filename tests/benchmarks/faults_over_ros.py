#!/usr/bin/env python3
"""Measure missions over the whole graph of nodes with each kind of fault, and without.

python3 tests/benchmarks/faults_over_ros.py [--seed 301] [--runs 2] [--only scan_nan ...]
    [--table docs/reports/faults_over_ros.md]
"""

import argparse
import json
import subprocess
import sys
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence

import yaml
from soak import RUNS, Graph, Leftovers

from evaluation.verdict import ARRIVAL_TOLERANCE
from headless_mission.fault_comparison import START
from planar import write_atomically
from sim_bridge.faults import KINDS, default_strength
from supervision.versions import provenance

# Time limit of a run, and additional time to end and to judge [wall s].
RUN_SECONDS, SPARE_SECONDS = 240.0, 60.0
CLEAN = "none"
PAGE = """# Faults over ROS

Look up what each kind of [fault](../reference/faults.md) does to the mission as a graph of nodes:
`./scripts/home_service.sh --faults FILE --timeout {limit:g}`, the fault from {start:g} s on, {runs} seeds
from {seed}.

{provenance}
* Command: `python3 tests/benchmarks/faults_over_ros.py --seed {seed} --runs {runs} --table
  docs/reports/faults_over_ros.md`

A verdict is false if the robot reports a delivery that did not take place, or the reverse; a run hangs if
the script has not ended {spare:g} s after the time limit. *Left* are processes, sockets and files.

| fault | succeeded | false verdicts | hung | left | simulated s | reason |
| --- | --- | --- | --- | --- | --- | --- |
{rows}
"""


@dataclass(frozen=True)
class Run:
    """A run: its result.json, whether it had to be ended, and what it left."""

    result: Dict[str, Any]
    hung: bool
    left: Sequence[str]

    @property
    def is_success(self) -> bool:
        return bool(self.result.get("success"))

    @property
    def is_false(self) -> bool:
        """Whether the state that the robot reports is wrong."""
        deliveries = self.result.get("deliveries", [])
        is_delivered = bool(deliveries) and all(map(_is_proven, deliveries))
        return (self.result.get("final_state") == "delivered") != is_delivered


def _is_proven(delivery: Dict[str, Any]) -> bool:
    """Return whether the robot was at both places when it reported so."""
    errors = (delivery["pickup_error"], delivery["dropoff_error"])
    is_there = all(error is not None and error <= ARRIVAL_TOLERANCE for error in errors)
    return delivery["state"] == "delivered" and is_there


@dataclass(frozen=True)
class Row:
    """All runs with a kind of fault."""

    kind: str
    runs: Sequence[Run]

    @property
    def is_needless_failure(self) -> bool:
        survivable = self.kind == CLEAN or KINDS[self.kind].survivable
        return survivable and 2 * sum(run.is_success for run in self.runs) < len(self.runs)

    @property
    def is_ok(self) -> bool:
        is_bad = any(run.hung or run.is_false or run.left for run in self.runs)
        return not is_bad and not self.is_needless_failure

    @property
    def line(self) -> str:
        runs = self.runs
        seconds = ", ".join(f"{run.result.get('simulated_seconds', 0.0):.0f}" for run in runs)
        failures = (str(run.result.get("reason", "no result")) for run in runs if not run.is_success)
        cells = (
            f"`{self.kind}`",
            f"{sum(run.is_success for run in runs)} of {len(runs)}",
            sum(run.is_false for run in runs),
            sum(run.hung for run in runs),
            sum(len(run.left) for run in runs),
            seconds,
            "; ".join(dict.fromkeys(failures)),
        )
        return f"| {' | '.join(map(str, cells))} |"


def run(kind: str, seed: int, leftovers: Leftovers) -> Run:
    """Run the mission with a fault, by its script."""
    folder = Path(leftovers.environment["TMPDIR"]) / RUNS
    folder.mkdir(exist_ok=True)
    faults = folder / f"{kind}.yaml"
    listed = [] if kind == CLEAN else [{"kind": kind, "start": START, "strength": default_strength(kind)}]
    faults.write_text(yaml.safe_dump({"faults": listed}))
    before = set(folder.iterdir())
    options = ("--faults", str(faults), "--seed", str(seed), "--timeout", str(RUN_SECONDS))
    graph = Graph(leftovers, "home_service.sh", *options)
    hung = False
    try:
        graph.process.wait(RUN_SECONDS + SPARE_SECONDS)
    except subprocess.TimeoutExpired:
        hung = True
        graph.end()
    return Run(_result_in(sorted(set(folder.iterdir()) - before)), hung, leftovers.find())


def _result_in(folders: Sequence[Path]) -> Dict[str, Any]:
    found = [each / "result.json" for each in folders if (each / "result.json").is_file()]
    return json.loads(found[-1].read_text()) if found else {}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=301, help="the first (default: 301)")
    parser.add_argument("--runs", type=int, default=2, help="of each kind (default: 2)")
    kinds = [CLEAN, *KINDS]
    parser.add_argument("--only", nargs="+", default=kinds, choices=kinds, metavar="KIND")
    parser.add_argument("--table", type=Path, help="Markdown file for the table", metavar="FILE")
    options = parser.parse_args()
    leftovers = Leftovers()
    rows: List[Row] = []
    for kind in options.only:
        runs = [run(kind, seed, leftovers) for seed in range(options.seed, options.seed + options.runs)]
        rows.append(Row(kind, runs))
        print(rows[-1].line, flush=True)
        _write(options.table, rows, options)
    return int(not all(row.is_ok for row in rows))


def _write(table: Optional[Path], rows: Sequence[Row], options: argparse.Namespace) -> None:
    if table is None:
        return
    limits = {"start": START, "limit": RUN_SECONDS, "spare": SPARE_SECONDS}
    lines = "\n".join(row.line for row in rows)
    text = PAGE.format(
        rows=lines, runs=options.runs, seed=options.seed, provenance=provenance(date.today()), **limits
    )
    write_atomically(table, text.encode("utf-8"))


if __name__ == "__main__":
    sys.exit(main())
