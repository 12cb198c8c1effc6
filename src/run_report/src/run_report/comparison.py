"""Comparison of two runs."""

import json
from html import escape
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Tuple

from planar.files.reading import read_text
from run_report.charts import ChartLine, chart
from run_report.figures import localization_errors, real_time_factors
from run_report.map_view import map_svg
from run_report.page import badge, document, figures
from run_report.record import RecordError, RunRecord, load_record

RESULT_FILE = "result.json"
KINDS = ("a", "b")
INPUTS = ("seed", "speed", "world", "map", "mission", "robot")


class LoadedRun(NamedTuple):
    """Content of a run folder."""

    folder: Path
    result: Dict[str, Any]
    record: RunRecord


class ComparisonRow(NamedTuple):
    """A figure of both runs as text; empty where a run has none."""

    name: str
    first: str
    second: str


def load_run(folder: Path) -> LoadedRun:
    """Read result and record of a run folder.

    Raises:
        RecordError: If one is missing or broken.
    """
    path = folder / RESULT_FILE
    try:
        result = json.loads(read_text(path))
    except FileNotFoundError:
        raise RecordError(f"{folder}: not the folder of a run (no {RESULT_FILE} in it)") from None
    except (OSError, ValueError, RecursionError) as error:
        raise RecordError(f"{path}: cannot be read ({error})") from None
    if not isinstance(result, dict):
        raise RecordError(f"{path}: not the result of a run")
    try:
        dict(figures(result)), _made_from(result)
    except (TypeError, ValueError, LookupError, AttributeError, OverflowError) as error:
        raise RecordError(f"{path}: not the result of a run ({error})") from None
    return LoadedRun(folder, result, load_record(folder))


def compared_figures(first: LoadedRun, second: LoadedRun) -> List[ComparisonRow]:
    """Return the figures of both runs, and the inputs and versions that differ."""
    rows = [ComparisonRow("outcome", *(_outcome(run) for run in (first, second)))]
    shown = [dict(figures(run.result)) for run in (first, second)]
    rows += [
        ComparisonRow(name, shown[0].get(name, ""), shown[1].get(name, ""))
        for name in {**shown[0], **shown[1]}
    ]
    made_from = [_made_from(run.result) for run in (first, second)]
    for name in {**made_from[0], **made_from[1]}:
        values = [made.get(name, "") for made in made_from]
        if values[0] != values[1]:
            rows.append(ComparisonRow(name, *values))
    return rows


def comparison_html(first: LoadedRun, second: LoadedRun) -> str:
    """Return a page with both runs in every chart."""
    runs = (first, second)
    end = max(run.record.end for run in runs)
    heads = "".join(f'<th><span class="key {kind}">{kind.upper()}</span></th>' for kind in KINDS)
    cells = "".join(
        f"<tr><td>{escape(row.name)}</td><td>{escape(row.first)}</td><td>{escape(row.second)}</td></tr>"
        for row in compared_figures(first, second)
    )
    lines: List[Tuple[str, str, List[ChartLine]]] = [
        ("Localization error", "m", _lines(runs, lambda record: localization_errors(record)[:, :2])),
        ("Forward speed", "m/s", _lines(runs, lambda record: record.velocity[:, :2])),
        ("Real-time factor", "simulated s per s", _lines(runs, real_time_factors)),
    ]
    maps = "".join(
        f'<div class="card"><h2>{badge(run.result)} {kind.upper()}: {escape(run.folder.name)}</h2>'
        f"{map_svg(run.record)}</div>"
        for kind, run in zip(KINDS, runs)
    )
    return document(
        f"{first.folder.name} and {second.folder.name}",
        f"<header><h1>Two runs</h1></header>"
        f'<section class="even columns">{maps}</section>'
        '<section class="even columns"><div class="card scroll"><table>'
        f"<thead><tr><th></th>{heads}</tr></thead><tbody>{cells}</tbody></table></div>"
        f'<div class="card charts">{"".join(chart(*line, end) for line in lines)}</div></section>',
    )


def _outcome(run: LoadedRun) -> str:
    return "success" if run.result.get("success") else f"failure: {run.result.get('reason', '')}"


def _made_from(result: Dict[str, Any]) -> Dict[str, str]:
    made = {name: str(result[name]) for name in INPUTS if name in result}
    return {**made, **{name: str(version) for name, version in result.get("versions", {}).items()}}


def _lines(runs, rows_of) -> List[ChartLine]:
    return [ChartLine(kind.upper(), kind, rows_of(run.record)) for kind, run in zip(KINDS, runs)]
