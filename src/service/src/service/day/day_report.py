"""Report of a simulated day: one self-contained HTML file."""

import math
from datetime import timezone
from html import escape
from typing import List, Sequence, Tuple

import numpy as np
from PIL import Image

from planar import UNKNOWN, OccupancyGrid
from run_report.charts import ChartLine, chart
from run_report.grid_image import data_uri, grid_image
from run_report.page import document, table, tiles
from service.day.simulated_day import SimulatedDayRecord
from service.requests.calendar_times import clock_text
from service.task import ServiceTask, TaskStatus

HOUR = 3600.0
# Size of a cell of the heat map [m], and seconds in it from which its colour is the strongest.
CELL, STRONGEST_SECONDS = 0.25, 60.0
OCCUPIED_COLOUR, FREE_COLOUR, UNKNOWN_COLOUR = (60, 60, 60, 255), (255, 255, 255, 255), (225, 225, 225, 255)
HOT = np.array((214, 69, 38, 255))
# Colours of what the robot does, by the first word of its activity.
ACTIVITY_COLOURS = {
    "driving": "#2f6fb3",
    "docking": "#8a5fb0",
    "undocking": "#8a5fb0",
    "charging": "#3c9a5f",
    "idle": "#c9ccd1",
}
OTHER_COLOUR = "#d9a13b"


def day_report(record: SimulatedDayRecord, grid: OccupancyGrid, midnight: float, title: str) -> str:
    """Return the page of a day.

    Args:
        record: What came of the day.
        grid: Map.
        midnight: Unix time at which the day began [s].
        title: Heading.
    """
    track = np.array(record.track).reshape(-1, 5)
    end = max(record.end - midnight, 1.0)
    return document(
        title,
        f"<h1>{escape(title)}</h1>"
        + tiles(_figures(record, track))
        + f'<section class="card">{_timeline(record.activities, midnight, end)}</section>'
        + f'<section class="card charts">{_battery(track, midnight, end)}</section>'
        + f'<section class="card"><h2>Where the robot was</h2>{_heat_map(track, grid)}</section>'
        + f'<section class="card"><h2>Requests</h2>{_requests(record.ended, midnight)}</section>',
    )


def _battery(track: np.ndarray, midnight: float, end: float) -> str:
    """Return a chart of the charge; empty if none is known."""
    known = track[np.isfinite(track[:, 4])]
    if not len(known):
        return ""
    charge = np.column_stack(((known[:, 0] - midnight) / HOUR, 100.0 * known[:, 4]))
    line = ChartLine("", "estimate", charge)
    return chart("Battery over the hours of the day", "%", (line,), end / HOUR, "h")


def _figures(record: SimulatedDayRecord, track: np.ndarray) -> List[Tuple[str, str]]:
    steps = np.diff(track[:, 1:3], axis=0)
    done = sum(task.status is TaskStatus.COMPLETED for task in record.ended)
    empty = "never" if record.empty_at is None else _clock(record.empty_at)
    return [
        ("requests done", f"{done} of {len(record.ended)}"),
        ("deadlines kept", f"{len(record.kept)} of {len(record.with_deadline)}"),
        ("refused", str(len(record.refused))),
        ("driven", f"{np.hypot(*steps.T).sum():.0f} m"),
        ("lowest charge", f"{100.0 * record.lowest_charge:.0f} %"),
        ("battery empty", empty),
        ("collisions", ", ".join(record.contacts) or "none"),
        ("idle, skipped", f"{record.idle_seconds / HOUR:.1f} h"),
    ]


def _timeline(activities: Sequence[Tuple[float, str]], midnight: float, end: float) -> str:
    """Return a bar of what the robot did, with a legend."""
    bars = []
    ends = [stamp for stamp, _ in activities[1:]] + [midnight + end]
    for (stamp, text), until in zip(activities, ends):
        left, width = (100.0 * (stamp - midnight) / end, 100.0 * (until - stamp) / end)
        colour = ACTIVITY_COLOURS.get(text.split()[0], OTHER_COLOUR)
        tip = escape(f"{_clock(stamp)} to {_clock(until)}: {text}")
        bars.append(
            f'<rect x="{left:.3f}" y="0" width="{max(width, 0.08):.3f}" height="3" fill="{colour}">'
            f"<title>{tip}</title></rect>"
        )
    places = [(hour, 100.0 * hour * HOUR / end) for hour in range(0, math.floor(end / HOUR) + 1, 3)]
    labels = "".join(
        f'<text x="{x:.2f}" y="4.3" font-size="0.9" text-anchor="{_anchor(x)}">{hour}</text>'
        for hour, x in places
    )
    legend = " ".join(
        f'<span style="color:{colour}">&#9632;</span> {name}'
        for name, colour in [*ACTIVITY_COLOURS.items(), ("handling an object, waiting", OTHER_COLOUR)]
    )
    return (
        "<figure><figcaption>What the robot did, over the hours of the day</figcaption>"
        f'<svg viewBox="0 0 100 5" width="100%">{"".join(bars)}{labels}</svg>'
        f"<small>{legend}</small></figure>"
    )


def _anchor(percent: float) -> str:
    """Return the SVG anchor with which a short label at a place of a bar stays within it."""
    return "start" if percent < 2.0 else "end" if percent > 98.0 else "middle"


def _heat_map(track: np.ndarray, grid: OccupancyGrid) -> str:
    """Return the map with the time that the robot spent in each place while it was stepped."""
    image = np.array(grid_image(grid, OCCUPIED_COLOUR, FREE_COLOUR, UNKNOWN_COLOUR), dtype=float)
    cells = max(1, round(CELL / grid.resolution))
    counts = np.zeros((math.ceil(grid.rows / cells), math.ceil(grid.cols / cells)))
    if len(track):
        inside = grid.cells_of(track[:, 1:3])
        np.add.at(counts, tuple((inside[grid.contains(inside)] // cells).T), 1.0)
    shares = np.where(counts > 0.0, 0.2 + 0.7 * np.sqrt(np.minimum(counts / STRONGEST_SECONDS, 1.0)), 0.0)
    shares = np.flipud(shares.repeat(cells, 0).repeat(cells, 1)[: grid.rows, : grid.cols])[..., None]
    mixed = np.rint((1.0 - shares) * image + shares * HOT).astype(np.uint8)
    rows, cols = (np.flatnonzero((grid.cells[::-1] != UNKNOWN).any(axis=axis)) for axis in (1, 0))
    if len(rows):
        mixed = mixed[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1]
    source = data_uri(Image.fromarray(mixed))
    return f'<img src="{source}" alt="heat map" style="image-rendering:pixelated;width:100%">'


def _requests(tasks: Sequence[ServiceTask], midnight: float) -> str:
    heads = ("asked", "request", "due", "ended", "result", "reason")
    ordered = sorted(tasks, key=lambda task: task.finished_at or midnight)
    return table(heads, [_row(task) for task in ordered])


def _row(task: ServiceTask) -> Tuple[str, ...]:
    request, result = task.request, task.status.value + (", late" if task.is_late else "")
    times = (request.release, request.deadline, task.finished_at)
    asked, due, ended = ("" if stamp is None else _clock(stamp) for stamp in times)
    return asked, task.request.description.text, due, ended, result, task.reason or _why_late(task)


def _why_late(task: ServiceTask) -> str:
    """Return why a task that was done was late, as far as its times show."""
    if not task.is_late or task.started_at is None or task.request.deadline is None:
        return ""
    waited = task.started_at - task.request.release
    if task.interruptions:
        return f"interrupted {task.interruptions} times"
    return (
        f"waited {waited:.0f} s for others" if waited > 30.0 else "the drive took longer than there was time"
    )


def _clock(stamp: float) -> str:
    return clock_text(stamp, timezone.utc)[-8:]
