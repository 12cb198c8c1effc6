#!/usr/bin/env python3
"""Object search in generated homes: success weighted by path length (SPL), against visiting all places.

python3 tests/benchmarks/object_search.py [--homes 1000] [--objects 3] [--sigma 0.7] [--uniform 0.15]

A home of 40 to 250 m2 is generated for each seed, and objects are placed in it. Where an object truly is, is
drawn from a distribution that the searcher does not have: each weight of the prior, of furniture and rooms,
is multiplied by exp(normal(0, SIGMA)), drawn for each home and object, and with the probability UNIFORM the
object is on any piece of furniture; on the piece its position is uniform. A look detects it by the declared
sensor model (planar.detection), judged by the true geometry of walls and tall furniture. All searchers have
the same views, sensor and chance, and end by the same rule; they differ in the order:

  search        pick_objects.search: posterior and beam search
  nearest       visits each piece of furniture, always the nearest that is left, in rounds
  nearest, new  the same without pieces of which a look has shown something in this round
  likeliest     visits the pieces in the order of the posterior

SPL (Anderson et al., "On evaluation of embodied navigation agents", 2018) is the mean of success * L / max(P,
L): P is the path driven, L the shortest path to where the object can be detected with at least half of the
best probability. Objects that are seen within 1 m of the start are drawn again. Ratios have 95 % intervals of
a bootstrap over homes. Exit code: 0 if the lower end of the ratio to ``nearest`` is at least --required.
"""

import argparse
import json
import multiprocessing
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
from helpers.furnished_homes import draw_placement, furnished_home

from pick_objects.search import ObjectSearch, SearchArea
from pick_objects.search.object_search import SEEN
from planar import Pose2, write_atomically
from planar.detection import DetectionModel

MODEL, START = DetectionModel(), Pose2()
# Homes between two reports of progress.
REPORTED_HOMES = 25
MAX_LOOKS, MIN_SHORTEST, DRAWS, RESAMPLES = 400, 1.0, 20, 4000
SEARCHERS = ("search", "nearest", "nearest, new", "likeliest")


class Orders:
    """The orders in which searchers look."""

    def __init__(self, area, search):
        self.area, self.search = area, search
        points = area.top_of_point[None, :] == np.arange(len(area.tops))[:, None]
        sums = area.detection @ points.T
        self.view_of_top, self.is_seen = sums.argmax(axis=0), sums.max(axis=0) > 0.0
        self.shown = area.detection @ (points / points.sum(axis=1, keepdims=True)).T
        self.left = set()

    def next(self, name, base):
        """Return the next view, None if the search has ended."""
        if name == "search":
            return self.search.next_view(base)
        if self.search.is_over(base):
            return None
        seconds = self.area.seconds_to_views(base)[self.view_of_top]
        can = {top for top in range(len(seconds)) if self.is_seen[top] and np.isfinite(seconds[top])}
        self.left = (self.left & can) or can
        posterior = list(self.search.posterior().values())
        cost = [-each for each in posterior] if name == "likeliest" else seconds
        return int(self.view_of_top[min(self.left, key=lambda top: (cost[top], top))])

    def on_look(self, name, view):
        """Note which pieces were visited by a look that showed nothing."""
        tops = {top for top in self.left if self.view_of_top[top] == view}
        if name == "nearest, new":
            tops |= {top for top in self.left if self.shown[view][top] > SEEN}
        self.left -= tops


def is_hidden(at, points_xy, solids):
    """Return whether walls or tall furniture hide a point (x, y) from each point (N, 2): slabs of rectangles.

    Shelves are open: a piece hides nothing of what stands in it.
    """
    holds = ((solids[:, :2] <= at) & (solids[:, 2:] >= at)).all(axis=1)
    solids = solids[~holds]
    directions = np.array(at) - points_xy
    with np.errstate(divide="ignore", invalid="ignore"):
        low = (solids[None, :, :2] - points_xy[:, None]) / directions[:, None]
        high = (solids[None, :, 2:] - points_xy[:, None]) / directions[:, None]
    enter, leave = np.fmin(low, high).max(axis=2), np.fmax(low, high).min(axis=2)
    hits = (enter <= leave) & (leave > 0.0)
    first = np.where(hits, enter, np.inf).min(axis=1, initial=np.inf)
    return first < 1.0


def true_probability(view, at, solids):
    """Return the probability that a look from a pose detects an object."""
    offset = view.inverse() @ Pose2(*at)
    reach, bearing = np.hypot(offset.x, offset.y), np.arctan2(offset.y, offset.x)
    if is_hidden(at, np.array([[view.x, view.y]]), solids)[0]:
        return 0.0
    return float(MODEL.probability_at(np.array(reach), np.array(bearing)))


def shortest_path(home, at, paths, lengths):
    """Return the shortest path to where the object is likely enough to be detected [m]; inf if nowhere."""
    step = 2
    cells = np.argwhere(paths.is_open)
    points = home.grid.points_of(cells * step)
    ranges = np.hypot(*(points - at).T)
    good = MODEL.probability_at(ranges, np.zeros(len(ranges))) >= MODEL.probability / 2.0
    good[good] &= ~is_hidden(at, points[good], home.solids)
    numbers = cells[good] @ (paths.is_open.shape[1], 1)
    return float(lengths[numbers].min(initial=np.inf))


def run(name, area, object_name, at, home, paths, rng):
    """Return success, path [m], looks and whether the object was seen of one search."""
    search, base, driven = ObjectSearch(area, object_name), START, 0.0
    orders = Orders(area, search)
    while search.looks < MAX_LOOKS:
        view = orders.next(name, base)
        if view is None:
            return {"success": False, "path": driven, "looks": search.looks}
        pose = area.views[view]
        driven += float(paths.lengths_from(paths.node_at(base.x, base.y))[paths.node_at(pose.x, pose.y)])
        base = pose
        if rng.random() < true_probability(pose, at, home.solids):
            return {"success": True, "path": driven, "looks": search.looks + 1}
        search.on_nothing_seen(view)
        orders.on_look(name, view)
    return {"success": False, "path": driven, "looks": search.looks}


def run_home(options, seed):
    """Return the results of all searches in a home."""
    home = furnished_home(seed)
    begin = time.process_time()
    area = SearchArea(home.grid, home.semantic_map, MODEL)
    _ = area.seconds_between_views
    prepared = time.process_time() - begin
    paths = area.paths
    lengths = paths.lengths_from(paths.node_at(START.x, START.y))
    rng, cases = np.random.default_rng([seed, 78]), []
    for number in range(options.objects):
        object_name = str(rng.choice(list(home.semantic_map.objects)))
        for _ in range(DRAWS):
            at = draw_placement(home, object_name, options.sigma, options.uniform, rng)
            shortest = shortest_path(home, at, paths, lengths)
            if MIN_SHORTEST <= shortest < np.inf:
                break
        else:
            continue
        case = {"home": seed, "object": object_name, "furniture": len(area.tops), "shortest": shortest}
        for name in SEARCHERS:
            chance = np.random.default_rng([seed, number, 79])
            case[name] = run(name, area, object_name, at, home, paths, chance)
        cases.append({**case, "seconds_to_prepare": prepared})
    return cases


def spl(case, name):
    """Return success weighted by path length of one search."""
    result = case[name]
    return result["success"] * case["shortest"] / max(result["path"], case["shortest"])


def summary(cases):
    """Return the figures of all searchers, and ratios of SPL with intervals."""
    homes = sorted({case["home"] for case in cases})
    index = {home: number for number, home in enumerate(homes)}
    sums = {name: np.zeros(len(homes)) for name in SEARCHERS}
    for case in cases:
        for name in SEARCHERS:
            sums[name][index[case["home"]]] += spl(case, name)
    draws = np.random.default_rng(0).integers(len(homes), size=(RESAMPLES, len(homes)))
    figures = {}
    for name in SEARCHERS:
        found = [case[name] for case in cases if case[name]["success"]]
        ratios = sums["search"][draws].sum(axis=1) / sums[name][draws].sum(axis=1)
        figures[name] = {
            "spl": float(sums[name].sum() / len(cases)),
            "success": len(found) / len(cases),
            "path": float(np.mean([each["path"] for each in found])),
            "looks": float(np.mean([each["looks"] for each in found])),
            "ratio": float(sums["search"].sum() / sums[name].sum()),
            "ratio_95": np.percentile(ratios, (2.5, 97.5)).tolist(),
        }
    return figures


def print_table(figures, cases, options):
    """Print the figures."""
    homes = len({case["home"] for case in cases})
    print(f"{homes} homes, {len(cases)} searches, sigma {options.sigma:g}, uniform {options.uniform:g}")
    print("| order | SPL | found | path, m | looks | SPL of search / SPL of order |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name, row in figures.items():
        low, high = row["ratio_95"]
        ratio = "1" if name == "search" else f"{row['ratio']:.3f} [{low:.3f}, {high:.3f}]"
        found = f"{100.0 * row['success']:.1f} %"
        print(f"| {name} | {row['spl']:.4f} | {found} | {row['path']:.1f} | {row['looks']:.1f} | {ratio} |")
    seconds = [case["seconds_to_prepare"] for case in cases]
    print(
        f"views of a home: {np.median(seconds):.2f} s of CPU time in the median, at most {max(seconds):.2f} s"
    )


def main():
    """Run the searches."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--homes", type=int, default=1000)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--objects", type=int, default=3, help="objects in each home")
    parser.add_argument("--sigma", type=float, default=0.7)
    parser.add_argument("--uniform", type=float, default=0.15)
    parser.add_argument("--required", type=float, default=1.3, help="least ratio of SPL to nearest")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--json", type=Path, help="also write figures and cases to this file, as they come")
    options = parser.parse_args()
    seeds = range(options.first_seed, options.first_seed + options.homes)
    cases, figures = [], {}
    with multiprocessing.get_context("spawn").Pool(options.jobs) as pool:
        for number, some in enumerate(pool.imap(partial(run_home, options), seeds), 1):
            cases += some
            if number % REPORTED_HOMES == 0 or number == options.homes:
                print(f"{number} homes", file=sys.stderr, flush=True)
                figures = summary(cases)
                if options.json:
                    write_atomically(
                        options.json, json.dumps({"figures": figures, "cases": cases}).encode("utf-8")
                    )
    print_table(figures, cases, options)
    return int(figures["nearest"]["ratio_95"][0] < options.required)


if __name__ == "__main__":
    sys.exit(main())
