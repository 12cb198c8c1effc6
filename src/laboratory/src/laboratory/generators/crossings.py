"""Generated moving cylinders in the style of DynaBARN (Nair et al., 2022)."""

import math
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import List, Tuple

import numpy as np

from laboratory.generators.motions import (
    HALF,
    MOTIONS,
    RADIUS,
    Course,
    Keyframes,
    crossing,
    from_phase,
    polynomials,
    timed,
)
from laboratory.worlds.solids import FLOOR, post, wall
from laboratory.worlds.source import Arena, GeneratedWorlds
from planar import Pose2
from planar.config.yaml_table import Table
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.world import Body, World

# Metres: thickness of walls, height of a cylinder. The start, as in DynaBARN, is outside of the open side.
THICKNESS, HEIGHT = 0.5, 1.0
DOOR_WALL_THICKNESS = 0.2
START, GOAL_IN_ODOM = Pose2(11.0, 0.0, math.pi), Pose2(20.0, 0.0)
MIN_SPEED, MAX_SPEED, MIN_COUNT, MAX_COUNT = 0.5, 1.9, 8, 14
CYLINDER_LIMIT, LEG_LIMIT, ORDER_LIMIT = 60, 20, 9
STRAIGHT, POLYNOMIALS = "straight", "polynomials"
_STREAM = 45


@dataclass(frozen=True)
class CrossingCylinders(GeneratedWorlds):
    """World source with different moving cylinders for each seed.

    Attributes:
        min_speed: Lowest speed [m/s]; if they move straight, all cylinders of a seed have about the same.
        max_speed: Highest speed [m/s].
        min_count: Smallest number of cylinders.
        max_count: Largest number of cylinders.
        legs: Straight segments of each trajectory of the motion ``straight``.
        motion: How they move: ``straight`` or one of laboratory.generators.motions.MOTIONS.
        orders: Lowest and highest order of the motion ``polynomials``.
    """

    min_speed: float = MIN_SPEED
    max_speed: float = MAX_SPEED
    min_count: int = MIN_COUNT
    max_count: int = MAX_COUNT
    legs: int = 1
    motion: str = STRAIGHT
    orders: Tuple[int, int] = (1, 6)

    def arena(self, seed: int) -> Arena:
        return _arena(self, seed)

    def course(self, rng: np.random.Generator) -> Tuple[str, Course]:
        """Return what the speed is called in results, and trajectories and walls."""
        speeds = self.min_speed, self.max_speed
        if self.motion == STRAIGHT:
            speed = rng.uniform(*speeds)
            count = int(rng.integers(self.min_count, self.max_count, endpoint=True))
            return f"{speed:.1f}", Course([_straight(self.legs, speed, rng) for _ in range(count)])
        move = MOTIONS[self.motion]
        if self.motion == POLYNOMIALS:
            move = partial(polynomials, orders=self.orders)
        count = int(rng.integers(self.min_count, self.max_count, endpoint=True))
        return f"{speeds[0]:.1f} to {speeds[1]:.1f}", move(count, speeds, rng)


@lru_cache(maxsize=64)
def _arena(source: CrossingCylinders, seed: int) -> Arena:
    speed, course = source.course(np.random.default_rng([seed, _STREAM]))
    bodies: List[Body] = [FLOOR, *_walls()]
    for number, (left, right, y) in enumerate(course.walls):
        bodies.append(wall(f"door_wall_{number}", 0.5 * (left + right), y, right - left, DOOR_WALL_THICKNESS))
    trajectories = []
    for number, (times, points_xy) in enumerate(course.trajectories):
        cylinder = post(f"crossing_{number}", Pose2(*points_xy[0]), RADIUS, HEIGHT, is_kinematic=True)
        bodies.append(cylinder)
        trajectories.append(ScriptedTrajectory(cylinder.name, times, points_xy))
    world = World(f"crossings {seed}", tuple(bodies), trajectories=tuple(trajectories))
    kind = "crossings" if source.motion == STRAIGHT else source.motion
    return Arena(world, None, f"{kind} at {speed} m/s", GOAL_IN_ODOM.x, start=START)


def _walls() -> List[Body]:
    side = 2.0 * HALF
    return [
        wall("far", -HALF, 0.0, THICKNESS, side),
        wall("left", 0.0, HALF, side, THICKNESS),
        wall("right", 0.0, -HALF, side, THICKNESS),
    ]


def _straight(legs: int, speed: float, rng: np.random.Generator) -> Keyframes:
    """Back and forth through random corners, from one side of the area to the opposite one."""
    limit = HALF - 2.0 * RADIUS
    start_xy, end_xy = crossing(rng)
    there_xy = np.vstack((start_xy, rng.uniform(-limit, limit, (legs - 1, 2)), end_xy))
    there_and_back = timed(np.concatenate((there_xy, there_xy[-2::-1])), speed * rng.uniform(0.9, 1.1))
    return from_phase(there_and_back, rng.random())


def read_crossings(table: Table, folder: Path) -> CrossingCylinders:
    """Read the table ``crossings``: ``speed`` [min, max] in m/s, and optionally ``cylinders`` [min, max],
    ``motion``, ``legs`` of the motion straight and ``orders`` [min, max] of polynomials.
    """
    table.allow_only("crossings")
    part = table.table("crossings")
    part.allow_only("speed", "cylinders", "legs", "motion", "orders")
    min_speed, max_speed = part.numbers("speed", "least, greatest")
    part.check(0.0 < min_speed <= max_speed <= 5.0, "speed", "two speeds up to 5 m/s, the lesser first")
    min_count, max_count = _counts(part, "cylinders", (MIN_COUNT, MAX_COUNT), 0, CYLINDER_LIMIT)
    motion = part.text("motion") if "motion" in part else STRAIGHT
    part.check(motion in (STRAIGHT, *MOTIONS), "motion", f"one of {', '.join((STRAIGHT, *MOTIONS))}")
    for key, needed in (("legs", STRAIGHT), ("orders", POLYNOMIALS)):
        part.check(motion == needed or key not in part, key, f"absent: it belongs to the motion {needed}")
    legs = part.count("legs", 1)
    part.check(legs <= LEG_LIMIT, "legs", f"at most {LEG_LIMIT}")
    orders = _counts(part, "orders", CrossingCylinders.orders, 1, ORDER_LIMIT)
    return CrossingCylinders(min_speed, max_speed, min_count, max_count, legs, motion, orders)


def _counts(part: Table, key: str, default: Tuple[int, int], least: int, most: int) -> Tuple[int, int]:
    """Two whole numbers, the lesser first."""
    if key not in part:
        return default
    low, high = part.numbers(key, "least, most")
    are_counts = low == int(low) and high == int(high) and least <= low <= high <= most
    part.check(are_counts, key, f"two whole numbers from {least} to {most}, the lesser first")
    return int(low), int(high)
