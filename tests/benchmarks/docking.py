#!/usr/bin/env python3
"""Dock from random starts, without ROS, and count what happens.

python3 tests/benchmarks/docking.py [--starts 200] [--seed 1] [--clutter 5] [--jobs 1] [--record FILE]

The dock stands at a wall. Starts are uniform in area within --distance and --angle of the dock's middle
line, with any heading. Boxes stand at random where they leave the robot's start and the last metre
before the dock free, and a path between them. The pose of the dock is known with an error of up to 0.3 m
and 10 degrees. A start counts as docked if the result is success and the simulated robot charges. Every
20 starts have another scene. Sensor noise is that of the profile --noise. With --record, each scene is
written when it is done, and scenes that the file has are not run again. Exit code 1 if fewer starts dock
than --least.
"""

import argparse
import json
import math
import multiprocessing
import sys
import time
from collections import Counter
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import List, Optional, Sequence, Tuple

import numpy as np

from auto_docking_lite import DockController, DockingSettings, DockResult
from headless_mission.docking import DockingHooks
from laboratory.statistics.summary import share
from planar import Pose2
from sim_bridge import Episode, Simulation, SimulationSettings, robot_named
from sim_bridge.docks import DOCK_NAME, with_dock
from sim_bridge.geometry.shapes import Plane
from sim_bridge.noise import noise_named
from sim_bridge.sensors.dock_ir import DockIrProfile
from sim_bridge.sensors.kobuki import KobukiProfile
from sim_bridge.sensors.lidar import LaserProfile
from sim_bridge.simulation import box_on_floor
from sim_bridge.world import Body, Collision, World

STARTS_PER_SCENE, STARTS_A_SEED = 20, 1000
# Half of the width and length of the area before the dock that is kept free of boxes [m].
FREE_HALF_WIDTH, FREE_LENGTH = 0.4, 1.3
ROBOT_RADIUS, PASSAGE = 0.18, 0.5
PRIOR_DISTANCE, PRIOR_ANGLE = 0.3, math.radians(10.0)
SECONDS = 240.0


@dataclass(frozen=True)
class Options:
    """What a start is drawn from."""

    distance: float
    angle: float
    clutter: int
    noise: str
    is_known: bool


@dataclass(frozen=True)
class Start:
    """A start and how it ended; poses in the dock's frame."""

    seed: int
    base_in_dock: Tuple[float, float, float]
    code: str
    text: str
    is_docked: bool
    seconds: float
    touched: Tuple[str, ...]
    cpu: float = 0.0
    has_touched_dock: bool = False

    @property
    def scene(self) -> int:
        """Seed of the scene."""
        return self.seed // STARTS_A_SEED


def scene_of(seed: int, options: Options) -> Tuple[World, np.ndarray]:
    """Return a world with a dock at the origin, and the boxes in it as circles (N, 3): x, y, radius [m]."""
    rng = np.random.default_rng([seed, 1])
    floor = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
    bodies = [floor, box_on_floor("wall", (0.1, 8.0, 1.0), Pose2(-0.13, 0.0))]
    circles: List[Tuple[float, float, float]] = []
    for number in range(int(rng.integers(0, options.clutter + 1))):
        size = rng.uniform(0.1, 0.5, 2)
        radius = float(np.hypot(*size)) / 2.0
        x, y = _point(rng, options)
        gap = [math.hypot(x - each[0], y - each[1]) - radius - each[2] for each in circles]
        is_before = x - radius < FREE_LENGTH and abs(y) - radius < FREE_HALF_WIDTH
        if is_before or min(gap, default=1.0) < PASSAGE:
            continue
        circles.append((x, y, radius))
        pose = Pose2(x, y, float(rng.uniform(-math.pi, math.pi)))
        bodies.append(box_on_floor(f"box_{number}", (size[0], size[1], 0.5), pose))
    return with_dock(World("docking", tuple(bodies)), Pose2()), np.array(circles).reshape(-1, 3)


def _point(rng: np.random.Generator, options: Options) -> Tuple[float, float]:
    distance = options.distance * math.sqrt(rng.uniform((0.3 / options.distance) ** 2, 1.0))
    angle = rng.uniform(-options.angle, options.angle)
    return distance * math.cos(angle), distance * math.sin(angle)


def start_of(rng: np.random.Generator, circles: np.ndarray, options: Options) -> Pose2:
    """Return a start at which the robot touches nothing."""
    while True:
        x, y = _point(rng, options)
        gaps = np.hypot(circles[:, 0] - x, circles[:, 1] - y) - circles[:, 2]
        if x > ROBOT_RADIUS + 0.05 and (gaps > ROBOT_RADIUS + 0.02).all():
            return Pose2(x, y, float(rng.uniform(-math.pi, math.pi)))


def run_scene(options: Options, seed: int, count: int = STARTS_PER_SCENE) -> List[Start]:
    """Dock from several starts in one scene."""
    world, circles = scene_of(seed, options)
    robot = robot_named("turtlebot_lidar")
    needed = (LaserProfile, KobukiProfile, DockIrProfile)
    robot = replace(robot, sensors=tuple(each for each in robot.sensors if isinstance(each, needed)))
    settings = SimulationSettings(**noise_named(options.noise))
    simulation = Simulation(world, robot, settings, seed, Pose2(0.9, 0.0, math.pi))
    simulation.mark()
    starts = []
    for number in range(count):
        rng = np.random.default_rng([seed, 2, number])
        base = start_of(rng, circles, options)
        begin, start_seed = time.process_time(), STARTS_A_SEED * seed + number
        simulation.rewind(start_seed, base)
        start = _run(simulation, base, start_seed, rng, options)
        starts.append(replace(start, cpu=time.process_time() - begin))
    simulation.close()
    return starts


def _run(simulation: Simulation, base: Pose2, seed: int, rng: np.random.Generator, options: Options) -> Start:
    settings = DockingSettings()
    controller = DockController(settings, seed=seed)
    hooks = DockingHooks(controller)
    hooks.odom_in_map = Pose2()
    touched: Counter = Counter()
    episode = Episode(simulation, settings.period, settings.period, hooks=(hooks,))
    dock = base.inverse()  # the odometry, and with it the map, starts at the robot
    distance, angle = PRIOR_DISTANCE * math.sqrt(rng.random()), rng.uniform(-math.pi, math.pi)
    error = Pose2(
        distance * math.cos(angle), distance * math.sin(angle), rng.uniform(-PRIOR_ANGLE, PRIOR_ANGLE)
    )
    controller.start(0.0, dock @ error if options.is_known else None)
    result: Optional[DockResult] = None
    while result is None:
        step = episode.advance()
        touched.update(step.contacts)
        result = hooks.decision.result
    power = step.kobuki and step.kobuki.power
    is_docked = result.is_success and bool(power and power.charger)
    others = tuple(name for name in touched if not name.startswith(DOCK_NAME))
    pose, outcome = (base.x, base.y, base.yaw), (result.code.name, result.text, is_docked)
    has_touched_dock = len(others) < len(touched)
    return Start(seed, pose, *outcome, step.stamp, others, has_touched_dock=has_touched_dock)


def recorded(path: Optional[Path], options: Options) -> List[Start]:
    """Return the starts that a record has; it must be of the same options."""
    if path is None or not path.exists():
        return []
    first, *lines = path.read_text().splitlines()
    if json.loads(first) != asdict(options):
        raise SystemExit(f"error: {path} was recorded with other options: {first}")
    starts = [Start(**start) for line in lines for start in json.loads(line)]
    return [replace(start, touched=tuple(start.touched)) for start in starts]


def append(path: Path, options: Options, starts: Sequence[Start]) -> None:
    """Append the starts of a scene to a record."""
    lines = [] if path.exists() else [json.dumps(asdict(options))]
    lines.append(json.dumps([asdict(start) for start in starts]))
    with path.open("a") as file:
        file.write("\n".join(lines) + "\n")


def report(starts: Sequence[Start]) -> str:
    """Return the table of an evaluation."""
    docked = sum(start.is_docked for start in starts)
    docking = share(docked, len(starts))
    seconds = np.array([start.seconds for start in starts if start.is_docked] or [math.nan])
    lines = [
        f"docked {docked} of {len(starts)}: {100.0 * docked / len(starts):.2f} % "
        f"(95 % interval {100.0 * docking.low:.2f} to {100.0 * docking.high:.2f} %)",
        f"time: median {np.median(seconds):.1f} s, 95 % {np.percentile(seconds, 95):.1f} s, "
        f"longest {seconds.max():.1f} s; CPU {np.mean([start.cpu for start in starts]):.2f} s a start",
        f"touched something but the dock: {sum(bool(start.touched) for start in starts)}; "
        f"the housing of the dock: {sum(start.has_touched_dock for start in starts)}",
    ]
    codes = Counter(start.code for start in starts if not start.is_docked)
    lines += [f"{count:6d} x {code}" for code, count in codes.most_common()]
    return "\n".join(lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--starts", type=int, default=200, help="number of starts (default: 200)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the first scene (default: 1)")
    parser.add_argument("--distance", type=float, default=3.0, help="largest distance [m] (default: 3)")
    parser.add_argument("--angle", type=float, default=60.0, help="largest angle [deg] (default: 60)")
    parser.add_argument("--clutter", type=int, default=5, help="largest number of boxes (default: 5)")
    parser.add_argument("--noise", default="turtlebot", help="noise profile (default: turtlebot)")
    parser.add_argument("--unknown", action="store_true", help="the pose of the dock is not known")
    parser.add_argument("--jobs", type=int, default=1, help="processes (default: 1)")
    parser.add_argument("--least", type=float, default=0.0, help="share that must dock (default: 0)")
    parser.add_argument("--failures", action="store_true", help="list the starts that failed")
    parser.add_argument("--record", type=Path, metavar="FILE", help="JSON lines, continued if it exists")
    given = parser.parse_args()
    options = Options(
        given.distance, math.radians(given.angle), given.clutter, given.noise, not given.unknown
    )
    scenes = range(given.seed, given.seed + math.ceil(given.starts / STARTS_PER_SCENE))
    starts = [start for start in recorded(given.record, options) if start.scene in scenes]
    scenes_left = sorted(set(scenes) - {start.scene for start in starts})
    with multiprocessing.get_context("spawn").Pool(given.jobs) as pool:
        for done in pool.imap(partial(run_scene, options), scenes_left):
            starts += done
            if given.record:
                append(given.record, options, done)
            docked = sum(start.is_docked for start in starts)
            print(f"{docked} of {len(starts)} docked", file=sys.stderr, flush=True)
    starts = sorted(starts, key=lambda start: start.seed)[: given.starts]
    print(report(starts))
    if given.failures:
        for start in starts:
            if not start.is_docked or start.touched or start.has_touched_dock:
                print(start)
    return int(sum(start.is_docked for start in starts) < given.least * len(starts))


if __name__ == "__main__":
    sys.exit(main())
