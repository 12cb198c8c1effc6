#!/usr/bin/env python3
"""Plans between random places of a map; measures computing time and plan length.

    python3 tests/benchmarks/planning.py MAP.yaml --size 1000 --pairs 100

Another planner can be compared through two files. --export writes costs and pairs: int32 cols, rows; uint8
costs; int32 count; int32 start col, start row, goal col, goal row of each. --compare reads the results of
that planner, a line each: points of the plan (0: none), milliseconds, length in cells.
"""

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np
from scipy.ndimage import label

from move_base_lite import settings_from_parameters
from move_base_lite.costmap import LayeredCostmap
from move_base_lite.planning import Navfn, NavfnSettings, PlanRequest
from planar import OccupancyGrid, load_map

# A TurtleBot's costmap.
PARAMETERS = {
    "global_costmap": {
        "robot_radius": 0.2,
        "plugins": [
            {"name": "static_layer", "type": "costmap_2d::StaticLayer"},
            {"name": "inflation_layer", "type": "costmap_2d::InflationLayer"},
        ],
        "inflation_layer": {"inflation_radius": 0.6, "cost_scaling_factor": 5.0},
    }
}
# Cost below which a cell may be start or goal.
FREE_COST = 128
VARIANTS = {
    "wavefront": NavfnSettings(),
    "A*": NavfnSettings(use_astar=True),
    "any angle": NavfnSettings(any_angle=True),
    "A*, any angle": NavfnSettings(use_astar=True, any_angle=True),
}


def main() -> int:
    options = _options()
    grid = _of_size(load_map(options.map), options.size)
    costmap = LayeredCostmap(settings_from_parameters(PARAMETERS)[0].global_costmap, grid)
    pairs = _pairs(costmap.costs, options.pairs, np.random.default_rng(options.seed))
    if options.export:
        _export(options.export, costmap.costs, pairs)
    figures = {name: _measure(costmap, pairs, settings) for name, settings in VARIANTS.items()}
    table = {name: _row(times, lengths) for name, (times, lengths) in figures.items()}
    if options.compare:
        other = np.loadtxt(options.compare).reshape(-1, 3)
        table["other"] = _row(other[:, 1], other[:, 2])
        both = other[:, 0] > 0
        for name, (times, lengths) in figures.items():
            table[name]["time_over_other"] = round(float(np.mean(times[both]) / np.mean(other[both, 1])), 3)
            table[name]["length_over_other"] = round(float(np.mean(lengths[both] / other[both, 2])), 4)
    print(json.dumps({"size": grid.cells.shape, "pairs": len(pairs), **table}, indent=2))
    return 0


def _measure(costmap: LayeredCostmap, pairs: np.ndarray, settings: NavfnSettings):
    """CPU milliseconds (N,) and lengths in cells (N,) of the plans of all pairs."""
    planner, window = Navfn(settings), costmap.window
    times, lengths = [], []
    for number, ends in enumerate([pairs[0], *pairs]):
        start_xy, goal_xy = (
            (
                window.origin_x + (col + 0.5) * window.resolution,
                window.origin_y + (row + 0.5) * window.resolution,
            )
            for col, row in ends.reshape(2, 2)
        )
        began = time.thread_time()
        path_xy = planner.plan(PlanRequest(costmap.costs, window, start_xy, goal_xy))
        if number:  # the first compiles
            times.append(1e3 * (time.thread_time() - began))
            lengths.append(np.linalg.norm(np.diff(path_xy, axis=0), axis=1).sum() / window.resolution)
    return np.array(times), np.array(lengths)


def _row(times: np.ndarray, lengths: np.ndarray) -> dict:
    return {
        "mean_ms": round(float(times.mean()), 2),
        "max_ms": round(float(times.max()), 2),
        "mean_cells": round(float(lengths.mean()), 1),
    }


def _of_size(grid: OccupancyGrid, size: int) -> OccupancyGrid:
    """The grid's middle; where it has too few rows or columns, each of its cells as several of that size."""
    times = max(-(-size // count) for count in grid.cells.shape)
    cells = np.kron(grid.cells, np.ones((times, times), np.int8))
    row, col = ((count - size) // 2 for count in cells.shape)
    return OccupancyGrid(np.ascontiguousarray(cells[row : row + size, col : col + size]), grid.resolution)


def _pairs(costs: np.ndarray, count: int, rng) -> np.ndarray:
    """Starts and goals (N, 4) as (col, row, col, row), in the largest connected part of the open cells."""
    regions, _ = label(costs < FREE_COST)
    largest = 1 + int(np.argmax(np.bincount(regions.ravel())[1:]))
    cells = np.argwhere(regions == largest)[:, ::-1]
    return cells[rng.integers(len(cells), size=(count, 2))].reshape(count, 4).astype(np.int32)


def _export(path: Path, costs: np.ndarray, pairs: np.ndarray) -> None:
    with path.open("wb") as file:
        np.array(costs.shape[::-1], np.int32).tofile(file)
        costs.tofile(file)
        np.array([len(pairs)], np.int32).tofile(file)
        pairs.tofile(file)


def _options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map", help="map_server file")
    parser.add_argument("--size", type=int, default=1000, help="rows and columns to plan on")
    parser.add_argument("--pairs", type=int, default=100, help="number of random pairs of start and goal")
    parser.add_argument("--seed", type=int, default=0, help="of the pairs")
    parser.add_argument("--export", type=Path, help="file for costs and pairs")
    parser.add_argument("--compare", type=Path, help="file of another planner's figures")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
