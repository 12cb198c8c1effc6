"""Generated moving cylinders in the style of DynaBARN (Nair et al., 2022)."""

import math
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import List

import numpy as np

from laboratory.worlds.solids import FLOOR, post, wall
from laboratory.worlds.source import Arena, GeneratedWorlds
from planar import Pose2
from planar.config.yaml_table import Table
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.world import Body, World

# Metres: half the side of the area, thickness of its walls, size of a cylinder. The start, as in DynaBARN, is
# outside of the open side.
HALF, THICKNESS, RADIUS, HEIGHT = 10.0, 0.5, 0.5, 1.0
START, GOAL_IN_ODOM = Pose2(11.0, 0.0, math.pi), Pose2(20.0, 0.0)
MIN_SPEED, MAX_SPEED, MIN_COUNT, MAX_COUNT = 0.5, 1.9, 8, 14
CYLINDER_LIMIT, LEG_LIMIT = 60, 20
_STREAM = 45


@dataclass(frozen=True)
class CrossingCylinders(GeneratedWorlds):
    """World source with different moving cylinders for each seed.

    Attributes:
        min_speed: Lowest speed [m/s]; all cylinders of a seed have about the same.
        max_speed: Highest speed [m/s].
        min_count: Smallest number of cylinders.
        max_count: Largest number of cylinders.
        legs: Straight segments of each trajectory.
    """

    min_speed: float = MIN_SPEED
    max_speed: float = MAX_SPEED
    min_count: int = MIN_COUNT
    max_count: int = MAX_COUNT
    legs: int = 1

    def arena(self, seed: int) -> Arena:
        return _arena(self, seed)


@lru_cache(maxsize=64)
def _arena(source: CrossingCylinders, seed: int) -> Arena:
    rng = np.random.default_rng([seed, _STREAM])
    speed = rng.uniform(source.min_speed, source.max_speed)
    bodies: List[Body] = [FLOOR, *_walls()]
    trajectories = []
    for number in range(rng.integers(source.min_count, source.max_count, endpoint=True)):
        waypoints_xy = _waypoints(source.legs, rng)
        cylinder = post(f"crossing_{number}", Pose2(*waypoints_xy[0]), RADIUS, HEIGHT, is_kinematic=True)
        bodies.append(cylinder)
        trajectories.append(_trajectory(cylinder.name, waypoints_xy, speed * rng.uniform(0.9, 1.1), rng))
    world = World(f"crossings {seed}", tuple(bodies), trajectories=tuple(trajectories))
    return Arena(world, None, f"crossings at {speed:.1f} m/s", GOAL_IN_ODOM.x)


def _walls() -> List[Body]:
    side = 2.0 * HALF
    return [
        wall("far", -HALF, 0.0, THICKNESS, side),
        wall("left", 0.0, HALF, side, THICKNESS),
        wall("right", 0.0, -HALF, side, THICKNESS),
    ]


def _waypoints(legs: int, rng: np.random.Generator) -> np.ndarray:
    """Random corners (legs + 1, 2) of a trajectory from one side of the area to the opposite one."""
    limit = HALF - 2.0 * RADIUS
    along = rng.uniform(-limit, limit, 2)
    across = np.array([-limit, limit])
    ends_xy = np.column_stack((along, across) if rng.random() < 0.7 else (across, along))
    return np.vstack((ends_xy[:1], rng.uniform(-limit, limit, (legs - 1, 2)), ends_xy[1:]))


def _trajectory(
    link: str, waypoints_xy: np.ndarray, speed: float, rng: np.random.Generator
) -> ScriptedTrajectory:
    """Back and forth along the waypoints, from a random phase."""
    arrival_times = (
        np.concatenate(([0.0], np.linalg.norm(np.diff(waypoints_xy, axis=0), axis=1).cumsum())) / speed
    )
    round_trip = 2.0 * float(arrival_times[-1])
    phase = rng.uniform(0.0, round_trip)
    corners = np.concatenate((arrival_times, round_trip - arrival_times[-2:0:-1]))
    ahead = np.sort((corners - phase) % round_trip)
    times = np.concatenate(([0.0], ahead[(ahead > 0.0) & (ahead < round_trip)], [round_trip]))
    path_times = (phase + times) % round_trip
    path_times = np.minimum(path_times, round_trip - path_times)
    return ScriptedTrajectory(
        link, times, np.column_stack([np.interp(path_times, arrival_times, xy) for xy in waypoints_xy.T])
    )


def read_crossings(table: Table, folder: Path) -> CrossingCylinders:
    """Read the table ``crossings``: ``speed`` [min, max] in m/s, and optionally ``cylinders`` [min, max] and
    ``legs``.
    """
    table.allow_only("crossings")
    part = table.table("crossings")
    part.allow_only("speed", "cylinders", "legs")
    min_speed, max_speed = part.numbers("speed", "least, greatest")
    part.check(0.0 < min_speed <= max_speed <= 5.0, "speed", "two speeds up to 5 m/s, the lesser first")
    min_count, max_count = (
        part.numbers("cylinders", "least, most") if "cylinders" in part else (MIN_COUNT, MAX_COUNT)
    )
    are_counts = (
        min_count == int(min_count)
        and max_count == int(max_count)
        and 0 <= min_count <= max_count <= CYLINDER_LIMIT
    )
    part.check(are_counts, "cylinders", f"two counts up to {CYLINDER_LIMIT}, the lesser first")
    legs = part.count("legs", 1)
    part.check(legs <= LEG_LIMIT, "legs", f"at most {LEG_LIMIT}")
    return CrossingCylinders(min_speed, max_speed, int(min_count), int(max_count), legs)
