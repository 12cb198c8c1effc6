"""Export of results as CSV and Parquet tables."""

import io
from dataclasses import asdict
from pathlib import Path
from typing import Iterable, Sequence, Tuple

from laboratory.results.result import RunResult
from laboratory.scenario.scenario import Scenario
from planar.files.writing import write_all_atomically


def export(runs: Iterable[Tuple[Scenario, Sequence[RunResult]]], folder: Path) -> None:
    """Write results.csv and results.parquet: one row for each run, without tracks. Raises FileWriteError."""
    import pandas

    rows = [
        {"scenario": scenario.name, "planner": scenario.planner, **asdict(result)}
        for scenario, results in runs
        for result in results
    ]
    table = pandas.DataFrame(rows).drop(columns="track", errors="ignore")
    parquet = io.BytesIO()
    table.to_parquet(parquet, engine="pyarrow", index=False)
    files = {"results.csv": table.to_csv(index=False).encode(), "results.parquet": parquet.getvalue()}
    write_all_atomically({folder / name: [data] for name, data in files.items()})
