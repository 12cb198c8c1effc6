"""Report of a run: one self-contained HTML file."""

import json
from html import escape
from pathlib import Path
from typing import Any, Iterable, List, Mapping, Sequence, Tuple

import numpy as np

from run_report.charts import ChartLine, chart, timeline
from run_report.figures import localization_errors, real_time_factors
from run_report.map_view import map_svg, thinned
from run_report.record import RunRecord

HERE = Path(__file__).resolve().parent
PLAYED_POSES = 1200
# The browser refuses everything that is not in the file.
POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"


def report_html(result: Mapping[str, Any], record: RunRecord) -> str:
    """Return the page for a result and a record."""
    return document(
        f"{result.get('command', 'run')}, seed {result.get('seed', '?')}",
        _header(result)
        + tiles(figures(result))
        + _gaps(result.get("missing", ()))
        + f'<section class="columns"><div class="card">{_map(record)}</div>'
        + f'<div class="card charts">{charts(record)}</div></section>'
        + _deliveries(result.get("deliveries", ()))
        + _warnings(record)
        + _inputs(result),
        script=_playback(record),
    )


def document(title: str, body: str, script: str = "") -> str:
    """Return a complete page around ``body``."""
    style = (HERE / "page.css").read_text(encoding="utf-8")
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
        '<meta name="viewport" content="width=device-width, initial-scale=1"><link rel="icon" href="data:,">'
        f"<style>{style}</style></head><body><main>{body}</main>{script}</body></html>\n"
    )


def figures(result: Mapping[str, Any]) -> List[Tuple[str, str]]:
    """Return names and values of the most important figures in a result, as text."""
    error = result.get("localization_error", {})
    rows: List[Tuple[str, Any, str]] = [
        ("simulated", result.get("simulated_seconds"), "{:.1f} s"),
        ("wall clock", result.get("wall_seconds"), "{:.1f} s"),
        ("real-time factor", result.get("real_time_factor"), "{:.1f} ×"),
        ("driven", result.get("distance_driven"), "{:.1f} m"),
        ("top speed", result.get("max_speed"), "{:.2f} m/s"),
        ("localization, mean", error.get("mean"), "{:.3f} m"),
        ("localization, worst", error.get("max"), "{:.3f} m"),
        *((f"off {zone}", value, "{:.3f} m") for zone, value in result.get("position_error", {}).items()),
        ("recall of walls", result.get("recall"), "{:.3f}"),
        ("precision of walls", result.get("precision"), "{:.3f}"),
        ("collisions", None if "collisions" not in result else len(result["collisions"]), "{}"),
        ("warnings", result.get("warnings"), "{}"),
    ]
    return [(name, pattern.format(value)) for name, value, pattern in rows if value is not None]


def tiles(rows: Iterable[Tuple[str, str]]) -> str:
    cells = "".join(f"<div><dt>{escape(name)}</dt><dd>{escape(value)}</dd></div>" for name, value in rows)
    return f'<dl class="tiles">{cells}</dl>'


def badge(result: Mapping[str, Any]) -> str:
    return (
        '<b class="badge good">success</b>' if result.get("success") else '<b class="badge bad">failure</b>'
    )


def table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    head = "".join(f"<th>{escape(name)}</th>" for name in heads)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def charts(record: RunRecord) -> str:
    """Return timeline, localization error, speed and real-time factor of a run."""
    errors, end = localization_errors(record), record.end
    return (
        timeline(record.states, end)
        + chart("Localization error", "m", [ChartLine("", "estimate", errors[:, :2])], end)
        + chart("Heading error", "°", [ChartLine("", "estimate", _degrees(errors[:, [0, 2]]))], end)
        + chart(
            "Speed",
            "m/s, rad/s",
            [
                ChartLine("forward", "truth", record.velocity[:, :2]),
                ChartLine("turning", "turning", record.velocity[:, ::2]),
            ],
            end,
        )
        + chart(
            "Real-time factor", "simulated s per s", [ChartLine("", "pace", real_time_factors(record))], end
        )
    )


def _degrees(rows: np.ndarray) -> np.ndarray:
    return rows * np.array([1.0, 180.0 / np.pi])


def _header(result: Mapping[str, Any]) -> str:
    return (
        f"<header>{badge(result)}<h1>{escape(str(result.get('command', 'run')))}"
        f" <small>seed {escape(str(result.get('seed', '?')))}</small></h1>"
        f"<p>{escape(str(result.get('reason', '')))}</p></header>"
    )


def _gaps(missing: Iterable[str]) -> str:
    items = "".join(f"<li>{escape(text)}</li>" for text in missing)
    return f'<section class="card gaps"><h2>Missing</h2><ul>{items}</ul></section>' if items else ""


def _map(record: RunRecord) -> str:
    kinds = [
        ("truth", "true", len(record.truth)),
        ("estimate", "estimated", len(record.estimate)),
        ("odometry", "odometry alone", len(record.odometry)),
        ("plan", "planned", len(record.plans)),
    ]
    keys = "".join(
        f'<label class="key {kind}"><input type="checkbox" checked data-kind="{kind}">{text}</label>'
        for kind, text, count in kinds
        if count
    )
    player = (
        '<div class="player"><button type="button" id="play" aria-label="Play">▶</button>'
        f'<input type="range" id="time" min="0" max="{record.end:.2f}" step="0.05" value="{record.end:.2f}" '
        'aria-label="Time"><output id="now"></output></div>'
        if len(record.truth) > 1
        else ""
    )
    return f'<div class="legend">{keys}</div>{map_svg(record)}{player}'


def _playback(record: RunRecord) -> str:
    if len(record.truth) < 2:
        return ""
    errors = localization_errors(record)
    data = {
        "truth": np.round(thinned(record.truth, PLAYED_POSES), 3).tolist(),
        "errors": np.round(thinned(errors[:, :2], PLAYED_POSES), 3).tolist(),
        "states": [list(state) for state in record.states],
        "markings": [list(marking) for marking in record.markings],
        "end": round(record.end, 3),
    }
    text = json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")
    code = (HERE / "page.js").read_text(encoding="utf-8")
    return f'<script type="application/json" id="run">{text}</script><script>{code}</script>'


def _deliveries(deliveries: Sequence[Mapping[str, Any]]) -> str:
    if not deliveries:
        return ""
    heads = list(dict.fromkeys(key for delivery in deliveries for key in delivery))
    if "retries" in heads:  # the goals that were sent count its drives as well
        heads.remove("attempts")
    rows = [[_shown(delivery.get(head)) for head in heads] for delivery in deliveries]
    drawn = table([head.replace("_", " ") for head in heads], rows)
    return f'<section class="card"><h2>Deliveries</h2>{drawn}</section>'


def _warnings(record: RunRecord) -> str:
    if not record.warnings:
        return ""
    rows = [(f"{warned.stamp:.1f} s", warned.node, warned.text) for warned in record.warnings]
    return f'<section class="card"><h2>Warnings</h2>{table(("when", "node", "text"), rows)}</section>'


def _inputs(result: Mapping[str, Any]) -> str:
    inputs = [(key, result[key]) for key in ("world", "map", "mission", "robot", "speed") if key in result]
    rows = inputs + sorted(result.get("versions", {}).items())
    cells = "".join(
        f"<div><dt>{escape(name)}</dt><dd>{escape(str(value))}</dd></div>" for name, value in rows
    )
    return f'<section class="card inputs"><h2>Made from</h2><dl>{cells}</dl></section>'


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.3f}"
    return "" if value is None else str(value)
