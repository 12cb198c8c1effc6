"""Cylinders that cross a place all the time, as in DynaBARN, others for each seed."""

import math
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import List, Tuple

import numpy as np

from laboratory.worlds.solids import FLOOR, post, wall
from laboratory.worlds.source import Arena
from planar import Pose2
from planar.config.yaml_table import Table
from sim_bridge.courses import Course
from sim_bridge.world import Body, World

# Metres: half the place's side, its walls, a cylinder; DynaBARN's start is outside its open side.
HALF, THICKNESS, RADIUS, HEIGHT = 10.0, 0.5, 0.5, 1.0
START, GOAL_IN_ODOM = Pose2(11.0, 0.0, math.pi), Pose2(20.0, 0.0)
SLOWEST, FASTEST, FEWEST, MOST = 0.5, 1.9, 8, 14
_STREAM = 45


@dataclass(frozen=True)
class Crossings:
    """``slowest``, ``fastest``: m/s; of each seed all cylinders are about as fast."""

    slowest: float = SLOWEST
    fastest: float = FASTEST

    def arena(self, seed: int) -> Arena:
        return _arena(self.slowest, self.fastest, seed)

    def files(self) -> Tuple[Path, ...]:
        return ()

    def arena_number(self, seed: int) -> int:
        return seed


@lru_cache(maxsize=64)
def _arena(slowest: float, fastest: float, seed: int) -> Arena:
    rng = np.random.default_rng([seed, _STREAM])
    speed = rng.uniform(slowest, fastest)
    bodies: List[Body] = [FLOOR, *_walls()]
    courses = []
    for number in range(rng.integers(FEWEST, MOST, endpoint=True)):
        ends_xy = _ends(rng)
        post_there = post(f"crossing_{number}", Pose2(*ends_xy[0]), RADIUS, HEIGHT, is_on_course=True)
        bodies.append(post_there)
        courses.append(_course(post_there.name, ends_xy, speed * rng.uniform(0.9, 1.1), rng))
    world = World(f"crossings {seed}", tuple(bodies), courses=tuple(courses))
    return Arena(world, None, f"crossings at {speed:.1f} m/s", GOAL_IN_ODOM.x)


def _walls() -> List[Body]:
    side = 2.0 * HALF
    return [
        wall("far", -HALF, 0.0, THICKNESS, side),
        wall("left", 0.0, HALF, side, THICKNESS),
        wall("right", 0.0, -HALF, side, THICKNESS),
    ]


def _ends(rng: np.random.Generator) -> np.ndarray:
    """From somewhere on one side to somewhere on the other, (2, 2)."""
    along = rng.uniform(-HALF + 2.0 * RADIUS, HALF - 2.0 * RADIUS, 2)
    across = np.array([-1.0, 1.0]) * (HALF - 2.0 * RADIUS)
    return np.column_stack((along, across) if rng.random() < 0.7 else (across, along))


def _course(link: str, ends_xy: np.ndarray, speed: float, rng: np.random.Generator) -> Course:
    """There and back for ever, begun anywhere on the way."""
    there = float(np.linalg.norm(ends_xy[1] - ends_xy[0])) / speed
    begun = rng.uniform(0.0, 2.0 * there)
    turns = np.array([-2.0 * there, -there, 0.0, there, 2.0 * there, 3.0 * there, 4.0 * there])
    inner = turns[(turns > begun) & (turns < begun + 2.0 * there)]
    times = np.concatenate(([begun], inner, [begun + 2.0 * there]))
    share = np.abs((times / there + 1.0) % 2.0 - 1.0)
    return Course(link, times - begun, ends_xy[0] + share[:, None] * (ends_xy[1] - ends_xy[0]))


def read_crossings(table: Table, folder: Path) -> Crossings:
    """``crossings``: the least and the greatest speed, m/s."""
    table.allow_only("crossings")
    part = table.table("crossings")
    part.allow_only("speed")
    slowest, fastest = part.numbers("speed", "least, greatest")
    part.check(0.0 < slowest <= fastest <= 5.0, "speed", "two speeds up to 5 m/s, the lesser first")
    return Crossings(slowest, fastest)
