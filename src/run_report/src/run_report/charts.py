"""Charts over time and the timeline of states, as responsive HTML."""

import math
from html import escape
from typing import Dict, List, NamedTuple, Sequence, Tuple

import numpy as np

from run_report.map_view import thinned
from run_report.record import StateEvent

HEIGHT = 100.0
# States that end a mission have fixed colours; others take turns.
FINAL_STATES = ("delivered", "failed", "cancelled")
TONES = 6
# States up to which the legend of a timeline lists each; of more, it lists each name once.
MOST_LISTED = 24


class ChartLine(NamedTuple):
    """A line of a chart.

    Attributes:
        name: Legend; empty: none.
        kind: CSS class.
        rows: (N, 2), stamp and value.
    """

    name: str
    kind: str
    rows: np.ndarray


def chart(title: str, unit: str, lines: Sequence[ChartLine], end: float, time_unit: str = "s") -> str:
    """Return a chart over 0..end seconds; empty without data."""
    lines = [line for line in lines if len(line.rows)]
    if not lines or end <= 0.0:
        return ""
    values = np.concatenate([line.rows[:, 1] for line in lines])
    ticks = nice_ticks(min(0.0, float(values.min())), float(values.max()))
    low, high = ticks[0], ticks[-1]

    def height_of(value):
        return (1.0 - (value - low) / (high - low)) * HEIGHT

    grid = "".join(
        f'<line class="grid" x1="0" x2="100" y1="{height_of(tick):.2f}" y2="{height_of(tick):.2f}"/>'
        for tick in ticks
    )
    drawn = "".join(
        f'<polyline class="line {line.kind}" points="'
        + " ".join(f"{100.0 * stamp / end:.3f},{height_of(value):.3f}" for stamp, value in thinned(line.rows))
        + '"/>'
        for line in lines
    )
    labels = "".join(f'<span class="y" style="top:{height_of(tick):.2f}%">{tick:g}</span>' for tick in ticks)
    legend = "".join(
        f'<span class="key {line.kind}">{escape(line.name)}</span>' for line in lines if line.name
    )
    return (
        f"<figure><figcaption>{escape(title)} <small>{escape(unit)}</small>{legend}</figcaption>"
        f'<div class="plot">{labels}<svg viewBox="0 0 100 {HEIGHT:g}" preserveAspectRatio="none">'
        f"{grid}{drawn}</svg>{time_labels(end, time_unit)}</div></figure>"
    )


def timeline(states: Sequence[StateEvent], end: float) -> str:
    """Return a bar of states over 0..end seconds with a legend."""
    if not states or end <= 0.0:
        return ""
    names = dict.fromkeys(state.name for state in states)
    passing = [name for name in names if name not in FINAL_STATES]
    tones = {name: f"tone{number % TONES}" for number, name in enumerate(passing)}
    tones.update({name: name for name in FINAL_STATES})
    ends = [state.stamp for state in states[1:]] + [end]
    bars = []
    for state, until in zip(states, ends):
        tone = tones[state.name]
        left, width = 100.0 * state.stamp / end, max(100.0 * (until - state.stamp) / end, 0.3)
        text = f"{state.name}: {state.stamp:.1f} to {until:.1f} s"
        bars.append(
            f'<i class="{tone}" style="left:{left:.2f}%;width:{width:.2f}%" title="{escape(text)}"></i>'
        )
    rows = [
        f'<li class="{tones[name]}">{escape(name)} <small>{text}</small></li>'
        for name, text in _durations(states, ends)
    ]
    return (
        f'<figure><figcaption>Mission</figcaption><div class="plot bar">{"".join(bars)}'
        f'{time_labels(end)}</div><ul class="states">{"".join(rows)}</ul></figure>'
    )


def _durations(states: Sequence[StateEvent], ends: Sequence[float]) -> List[Tuple[str, str]]:
    """Return names and durations of states in words; of many, the sum for each name."""
    seconds = [(state.name, until - state.stamp) for state, until in zip(states, ends)]
    if len(seconds) <= MOST_LISTED:
        return [(name, f"{duration:.1f} s") for name, duration in seconds]
    of_name: Dict[str, List[float]] = {}
    for name, duration in seconds:
        of_name.setdefault(name, []).append(duration)
    return [(name, f"{len(each)} x, {sum(each):.0f} s") for name, each in of_name.items()]


def time_labels(end: float, unit: str = "s") -> str:
    ticks = [tick for tick in nice_ticks(0.0, end, 6) if tick <= end]
    return "".join(
        f'<span class="x" style="left:{100.0 * tick / end:.2f}%">{tick:g}'
        f"{f' {unit}' if tick == ticks[-1] else ''}</span>"
        for tick in ticks
    )


def nice_ticks(low: float, high: float, most: int = 4) -> List[float]:
    """Return evenly spaced round numbers from at most ``low`` to at least ``high``."""
    span = max(high - low, 1e-3)
    rough = span / most
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= rough * (1.0 - 1e-9))
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    return [round(number * step, 10) for number in range(first, max(last, first + 1) + 1)]
