#!/usr/bin/env python3
"""Maps become homes, and the maps of these are compared with them; missions in the homes.

    python3 tests/benchmarks/home_imports.py MAP.yaml... --homes 0-9 --offices 0-4 --missions

For each map: the overlap, that is the smaller share of the occupied cells of one map with one of the other
within a cell; rooms that are reachable in the map, and how many of them are in the home's; seconds to import
and build; with --missions the verdict of the home's mission. --homes and --offices add the maps of generated
buildings. Other files that build_home.sh reads get missions only; pictures need --scale.
"""

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np
from helpers.command_line import seeds
from scipy.ndimage import label
from scipy.spatial import cKDTree

from headless_mission import HeadlessMission
from home_builder import HomePlan, build_home
from home_builder.imports import MAPS
from home_builder.imports.maps import plan_of_map
from home_builder.source import read_source
from laboratory.generators.homes import Homes
from laboratory.generators.offices import Offices
from pick_objects import load_mission
from planar import FREE, OCCUPIED, OccupancyGrid, PlanarError, load_map
from planar.geometry.distance_field import distance_field
from planar.maps.home_folder import load_home
from planar.maps.places import load_places
from sim_bridge import load_world, robot_named

# Clearance of the robot, of the middle of a room [m], and smallest such middle [m2].
PASSAGE, MIDDLE, MIN_AREA = 0.2, 0.5, 0.25


def main() -> int:
    options = _options()
    rows: List[Dict[str, Any]] = []
    for name, grid, path in _inputs(options):
        rows.append({"name": name, **_row(name, grid, path, options)})
        print(", ".join(f"{key} {value}" for key, value in rows[-1].items()), flush=True)
        if options.json is not None:
            options.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")
    overlaps = [row["overlap"] for row in rows if "overlap" in row]
    if overlaps:
        kept, total = (sum(row.get(key, 0) for row in rows) for key in ("rooms_kept", "rooms"))
        figures = f"median {np.median(overlaps):.4f}, worst {min(overlaps):.4f}"
        print(f"{len(overlaps)} maps: overlap {figures}; rooms {kept} of {total}")
    if options.missions:
        print(f"{sum(row.get('success', False) for row in rows)} of {len(rows)} missions succeeded")
    return 0


def _row(name: str, grid: Optional[OccupancyGrid], path: Path, options: argparse.Namespace) -> Dict[str, Any]:
    """Import and build a home, and run its mission; return the figures."""
    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder) / "home"
        try:
            plan = plan_of_map(grid, name) if grid is not None else read_source(path, options.scale)
            build_home(plan, home)
        except PlanarError as error:
            return {"error": str(error)}
        row: Dict[str, Any] = {"seconds": round(time.perf_counter() - started, 1)}
        if grid is not None:
            made = load_map(home / "home.yaml")
            kept, total = rooms_kept(grid, made, plan)
            row.update(overlap=round(overlap(grid, made, plan), 4), rooms_kept=kept, rooms=total)
        if options.missions:
            verdict = mission_in(home, options.seed)
            row.update(success=verdict.success, reason=verdict.reason)
        return row


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--homes", type=seeds, default=range(0), help="seeds of generated homes")
    parser.add_argument("--offices", type=seeds, default=range(0), help="seeds of generated offices")
    parser.add_argument("--missions", action="store_true", help="also run the mission of each home")
    parser.add_argument("--scale", type=float, help="size of a pixel of pictures [m]")
    parser.add_argument("--json", type=Path, help="also write the rows to this file")
    parser.add_argument("--seed", type=int, default=0, help="of the missions")
    return parser.parse_args()


def _inputs(options: argparse.Namespace) -> Iterator[Tuple[str, Optional[OccupancyGrid], Path]]:
    for path in options.files:
        yield path.name, load_map(path) if path.suffix in MAPS else None, path
    for kind, numbers in ((Homes, options.homes), (Offices, options.offices)):
        for seed in numbers:
            source = kind(*kind.areas)
            yield f"{kind.kind} {seed}", source.arena(seed).grid, Path()


def overlap(grid: OccupancyGrid, made: OccupancyGrid, plan: HomePlan) -> float:
    """Return the smaller share of occupied cells with one of the other map within a cell."""
    one_xy, other_xy = (each.points_of(np.argwhere(each.cells == OCCUPIED)) for each in (grid, made))
    other_xy = other_xy + plan.start
    reach = 1.5 * max(grid.resolution, made.resolution)
    pairs = ((other_xy, one_xy), (one_xy, other_xy))
    return min(float((cKDTree(a).query(b, p=np.inf)[0] <= reach).mean()) for a, b in pairs)


def rooms_kept(grid: OccupancyGrid, made: OccupancyGrid, plan: HomePlan) -> Tuple[int, int]:
    """Return how many rooms that the robot reaches in a map it also reaches in the home, and their number."""
    reached, clearance = _reached(grid, plan.start)
    middles, count = label(reached & (clearance > MIDDLE))
    in_home, _ = _reached(made, (0.0, 0.0))
    kept = total = 0
    for number in range(1, count + 1):
        cells = np.argwhere(middles == number)
        if len(cells) * grid.resolution**2 < MIN_AREA:
            continue
        there = made.cells_of(grid.points_of(cells) - plan.start)
        total += 1
        kept += bool(in_home[tuple(there[made.contains(there)].T)].mean() > 0.5)
    return kept, total


def _reached(grid: OccupancyGrid, start: Tuple[float, float]) -> Tuple[np.ndarray, np.ndarray]:
    clearance = distance_field(grid.cells != FREE, grid.resolution)
    regions, _ = label(clearance > PASSAGE)
    ((row, col),) = grid.cells_of([start])
    return (regions == regions[row, col]) & (regions > 0), clearance


def mission_in(folder: Path, seed: int):
    """Run the mission of a home in one process; return the verdict."""
    home = load_home(folder)
    grid = load_map(home.map)
    mission = load_mission(home.mission or "", load_places(home.zones), grid=grid)
    robot = robot_named("turtlebot_lidar")
    return HeadlessMission(load_world(home.world), robot, grid, mission, seed).run().verdict


if __name__ == "__main__":
    sys.exit(main())
