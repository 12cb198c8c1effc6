"""SVG maps of runs."""

from collections import Counter
from typing import List, Sequence

import numpy as np

from laboratory.results.result import RunResult, track_of
from laboratory.scenario.scenario import Scenario
from laboratory.worlds.source import Arena
from planar import OccupancyGrid
from run_report.map_view import map_svg
from run_report.record import RunRecord
from sim_bridge.views.true_map import true_map

# Cell size of the heat map [m].
SQUARE_SIZE = 0.5


def run_map(scenario: Scenario, result: RunResult) -> str:
    """Draw the world of a run with its true trajectory."""
    return map_svg(RunRecord(grid=_grid(scenario.arena(result.seed), result), truth=track_of(result)))


def heat_map(scenario: Scenario, failures: Sequence[RunResult]) -> str:
    """Draw where failed runs of one world ended: the redder a square, the more runs."""
    ends = [(run.end_x, run.end_y) for run in failures if run.end_x is not None and run.end_y is not None]
    squares = Counter(tuple(np.floor(np.array(end) / SQUARE_SIZE).astype(int).tolist()) for end in ends)
    most = max(squares.values())
    drawn: List[str] = []
    for (col, row), count in sorted(squares.items()):
        drawn.append(
            f'<rect x="{col * SQUARE_SIZE:g}" y="{-(row + 1) * SQUARE_SIZE:g}" '
            f'width="{SQUARE_SIZE}" height="{SQUARE_SIZE}" '
            f'fill="var(--bad)" fill-opacity="{0.25 + 0.65 * count / most:.2f}">'
            f"<title>{count} of {len(ends)} ended here</title></rect>"
        )
    grid = _grid(scenario.world.arena(failures[0].seed), failures[0])
    return map_svg(RunRecord(grid=grid), "".join(drawn))


def _grid(arena: Arena, result: RunResult) -> OccupancyGrid:
    """The true map of a run's world, including obstacles that the robot's map does not show."""
    _, x, y, _ = track_of(result)[0].tolist()
    return true_map(arena.world, inside=(x, y))
