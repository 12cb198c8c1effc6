#!/usr/bin/env python3
"""Shows what becomes of the errand over the whole graph with each kind of fault, beside the same without.

python3 tests/benchmarks/faults_over_ros.py [--seed 301] [--runs 2] [--only scan_nan ...]
    [--table docs/reports/faults_over_ros.md]
"""

import argparse
import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence

import yaml
from soak import RUNS, Graph, Traces

from home_service.judging.verdict import ARRIVAL_TOLERANCE
from home_service.rehearsal.twins import START
from planar import write_atomically
from sim_bridge.faults import KINDS, default_strength

# Wall seconds that a run may take, and that it may take beyond them to end and to judge.
RUN_SECONDS, SPARE_SECONDS = 240.0, 60.0
CLEAN = "none"
PAGE = """# Faults over ROS

The kinds of [faults](../reference/faults.md), from {start:g} s on, in the whole graph of nodes:
`./scripts/home_service.sh --faults FILE --timeout {limit:g}` over {runs} seeds from {seed}. Made by
`python3 tests/benchmarks/faults_over_ros.py --seed {seed} --runs {runs}
--table docs/reports/faults_over_ros.md`.

A verdict is false if the robot says that it has delivered and has not, or the other way round; a run hangs if
the script has not ended by itself {spare:g} s after that. *Left* are processes, sockets and files.

| fault | succeeded | false verdicts | hung | left | simulated s | why not |
| --- | --- | --- | --- | --- | --- | --- |
{rows}
"""


@dataclass(frozen=True)
class Run:
    """``result``: what result.json says; ``hung``: whether it had to be ended."""

    result: Dict[str, Any]
    hung: bool
    left: Sequence[str]

    @property
    def is_success(self) -> bool:
        return bool(self.result.get("success"))

    @property
    def is_false(self) -> bool:
        """Whether the robot said something of its mission that is not so."""
        deliveries = self.result.get("deliveries", [])
        is_delivered = bool(deliveries) and all(map(_is_proven, deliveries))
        return (self.result.get("final_state") == "delivered") != is_delivered


def _is_proven(delivery: Dict[str, Any]) -> bool:
    """Whether it was at both of its places when it said so."""
    errors = (delivery["pickup_error"], delivery["dropoff_error"])
    is_there = all(error is not None and error <= ARRIVAL_TOLERANCE for error in errors)
    return delivery["state"] == "delivered" and is_there


@dataclass(frozen=True)
class Row:
    """All runs with one kind of fault."""

    kind: str
    runs: Sequence[Run]

    @property
    def is_needless_failure(self) -> bool:
        survivable = self.kind == CLEAN or KINDS[self.kind].survivable
        return survivable and 2 * sum(run.is_success for run in self.runs) < len(self.runs)

    @property
    def is_well(self) -> bool:
        bad = any(run.hung or run.is_false or run.left for run in self.runs)
        return not bad and not self.is_needless_failure

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


def run(kind: str, seed: int, traces: Traces) -> Run:
    """The errand with this fault, from its script."""
    folder = Path(traces.environment["TMPDIR"]) / RUNS
    folder.mkdir(exist_ok=True)
    faults = folder / f"{kind}.yaml"
    listed = [] if kind == CLEAN else [{"kind": kind, "start": START, "strength": default_strength(kind)}]
    faults.write_text(yaml.safe_dump({"faults": listed}))
    before = set(folder.iterdir())
    options = ("--faults", str(faults), "--seed", str(seed), "--timeout", str(RUN_SECONDS))
    graph = Graph(traces, "home_service.sh", *options)
    hung = False
    try:
        graph.process.wait(RUN_SECONDS + SPARE_SECONDS)
    except subprocess.TimeoutExpired:
        hung = True
        graph.end()
    return Run(_result_in(sorted(set(folder.iterdir()) - before)), hung, traces.left())


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
    traces = Traces()
    rows: List[Row] = []
    for kind in options.only:
        runs = [run(kind, seed, traces) for seed in range(options.seed, options.seed + options.runs)]
        rows.append(Row(kind, runs))
        print(rows[-1].line, flush=True)
        _write(options.table, rows, options)
    return int(not all(row.is_well for row in rows))


def _write(table: Optional[Path], rows: Sequence[Row], options: argparse.Namespace) -> None:
    if table is None:
        return
    told = {"start": START, "limit": RUN_SECONDS, "spare": SPARE_SECONDS}
    lines = "\n".join(row.line for row in rows)
    text = PAGE.format(rows=lines, runs=options.runs, seed=options.seed, **told)
    write_atomically(table, text.encode("utf-8"))


if __name__ == "__main__":
    sys.exit(main())
