#!/usr/bin/env python3
"""Measures the overhead of a local planner plugin: its guard, and its loading by name.

A robot drives to the pick-up zone of the home, in one process. The overhead of the guard is the duration of a
call through it minus that of the planner.

python3 tests/benchmarks/plugin_cost.py [--json FILE] [PLANNER ...]
"""

import argparse
import json
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Callable, Dict, List
from unittest.mock import patch

import numpy as np

from headless_mission.localization import LocalizationHooks
from headless_mission.navigation import NavigationHooks
from move_base_lite import Navigator, NavigatorSettings, load_settings
from move_base_lite.warmup import warm_up
from planar import Pose2, load_map
from planar.extensions import Guard, load_object
from sim_bridge import Episode, Simulation, load_world

ROOT = Path(__file__).resolve().parents[2]
CONFIG = ROOT / "src" / "move_base_lite" / "config" / "turtlebot.yaml"
GOAL, SEED, MAX_TICKS = Pose2(2.0, 3.0, 0.0), 3, 1000
PLANNERS = ("plugin_examples.pure_pursuit/PurePursuit", "plugin_examples.critics/Critics")


@dataclass(frozen=True)
class Measurement:
    """Milliseconds, medians over the ticks; ``guard_share``: of a tick. ``load_ms``: once, at the start."""

    planner: str
    ticks: int
    tick_ms: float
    planner_ms: float
    guard_ms: float
    guard_share: float
    load_ms: float


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("planners", nargs="*", metavar="PLANNER", default=PLANNERS)
    parser.add_argument("--json", type=Path, metavar="FILE", help="writes the figures there too")
    options = parser.parse_args()
    print("planner                                     ticks  tick ms  planner ms  guard ms  share  load ms")
    measured = [measure(name) for name in options.planners]
    for one in measured:
        print(
            f"{one.planner:43} {one.ticks:5} {one.tick_ms:8.3f} {one.planner_ms:11.3f} {one.guard_ms:9.3f} "
            f"{one.guard_share:6.3f} {one.load_ms:8.1f}"
        )
    if options.json:
        options.json.write_text(json.dumps([asdict(one) for one in measured], indent=2) + "\n")
    return 0


def measure(name: str) -> Measurement:
    start = time.perf_counter()
    settings = load_settings(CONFIG, base_local_planner=name)
    load_ms = 1e3 * (time.perf_counter() - start)
    start = time.perf_counter()
    load_settings(CONFIG)
    load_ms -= 1e3 * (time.perf_counter() - start)
    warm_up(settings)
    kind, call_times = load_object(name), CallTimes()
    with patch.object(kind, "follow", call_times.timed("planner", kind.follow)), patch.object(
        Guard, "call", call_times.timed("guarded", Guard.call)
    ), patch.object(Navigator, "tick", call_times.timed("tick", Navigator.tick)):
        drive(settings)
    guarded, planner = (np.array(call_times.ms[what]) for what in ("guarded", "planner"))
    tick_ms, guard_ms = float(np.median(call_times.ms["tick"])), float(np.median(guarded - planner))
    return Measurement(
        name,
        len(call_times.ms["tick"]),
        tick_ms,
        float(np.median(planner)),
        guard_ms,
        guard_ms / tick_ms,
        load_ms,
    )


class CallTimes:
    """Durations of calls by name [ms]."""

    def __init__(self) -> None:
        self.ms: Dict[str, List[float]] = {}

    def timed(self, what: str, call: Callable) -> Callable:
        times_ms = self.ms.setdefault(what, [])

        def timed_call(*arguments, **named):
            start = time.perf_counter()
            try:
                return call(*arguments, **named)
            finally:
                times_ms.append(1e3 * (time.perf_counter() - start))

        return timed_call


def drive(settings: NavigatorSettings) -> None:
    """Drive to the goal."""
    grid, simulation = (
        load_map(ROOT / "map" / "home.yaml"),
        Simulation(load_world(ROOT / "map" / "home.world"), seed=SEED),
    )
    navigation = NavigationHooks(settings, grid)
    localization = LocalizationHooks(grid, SEED, Pose2(), navigation.poses)
    episode = Episode(simulation, navigation.period, hooks=(navigation, localization))
    navigation.move_base.set_goal(GOAL)
    for _ in range(MAX_TICKS):
        episode.advance()
        if navigation.result.decision.status.is_final:
            break
    simulation.close()


if __name__ == "__main__":
    sys.exit(main())
