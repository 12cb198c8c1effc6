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
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.world import Body, World

# Metres: half the place's side, its walls, a cylinder; DynaBARN's start is outside its open side.
HALF, THICKNESS, RADIUS, HEIGHT = 10.0, 0.5, 0.5, 1.0
START, GOAL_IN_ODOM = Pose2(11.0, 0.0, math.pi), Pose2(20.0, 0.0)
SLOWEST, FASTEST, FEWEST, MOST = 0.5, 1.9, 8, 14
MOST_CYLINDERS, MOST_LEGS = 60, 20
_STREAM = 45


@dataclass(frozen=True)
class Crossings:
    """``slowest``, ``fastest``: m/s; of each seed all cylinders are about as fast.

    There are ``fewest`` to ``most``, each with a way from side to side of so many straight ``legs``.
    """

    slowest: float = SLOWEST
    fastest: float = FASTEST
    fewest: int = FEWEST
    most: int = MOST
    legs: int = 1

    def arena(self, seed: int) -> Arena:
        return _arena(self, seed)

    def files(self) -> Tuple[Path, ...]:
        return ()

    def arena_number(self, seed: int) -> int:
        return seed


@lru_cache(maxsize=64)
def _arena(source: Crossings, seed: int) -> Arena:
    rng = np.random.default_rng([seed, _STREAM])
    speed = rng.uniform(source.slowest, source.fastest)
    bodies: List[Body] = [FLOOR, *_walls()]
    trajectories = []
    for number in range(rng.integers(source.fewest, source.most, endpoint=True)):
        way_xy = _way(source.legs, rng)
        post_there = post(f"crossing_{number}", Pose2(*way_xy[0]), RADIUS, HEIGHT, is_kinematic=True)
        bodies.append(post_there)
        trajectories.append(_course(post_there.name, way_xy, speed * rng.uniform(0.9, 1.1), rng))
    world = World(f"crossings {seed}", tuple(bodies), trajectories=tuple(trajectories))
    return Arena(world, None, f"crossings at {speed:.1f} m/s", GOAL_IN_ODOM.x)


def _walls() -> List[Body]:
    side = 2.0 * HALF
    return [
        wall("far", -HALF, 0.0, THICKNESS, side),
        wall("left", 0.0, HALF, side, THICKNESS),
        wall("right", 0.0, -HALF, side, THICKNESS),
    ]


def _way(legs: int, rng: np.random.Generator) -> np.ndarray:
    """From somewhere on one side, in so many straight legs, to somewhere on the other, (legs + 1, 2)."""
    most = HALF - 2.0 * RADIUS
    along = rng.uniform(-most, most, 2)
    across = np.array([-most, most])
    ends_xy = np.column_stack((along, across) if rng.random() < 0.7 else (across, along))
    return np.vstack((ends_xy[:1], rng.uniform(-most, most, (legs - 1, 2)), ends_xy[1:]))


def _course(link: str, way_xy: np.ndarray, speed: float, rng: np.random.Generator) -> ScriptedTrajectory:
    """There and back for ever, begun anywhere on the way."""
    reached = np.concatenate(([0.0], np.linalg.norm(np.diff(way_xy, axis=0), axis=1).cumsum())) / speed
    round_trip = 2.0 * float(reached[-1])
    begun = rng.uniform(0.0, round_trip)
    corners = np.concatenate((reached, round_trip - reached[-2:0:-1]))
    ahead = np.sort((corners - begun) % round_trip)
    times = np.concatenate(([0.0], ahead[(ahead > 0.0) & (ahead < round_trip)], [round_trip]))
    on_way = (begun + times) % round_trip
    on_way = np.minimum(on_way, round_trip - on_way)
    return ScriptedTrajectory(
        link, times, np.column_stack([np.interp(on_way, reached, xy) for xy in way_xy.T])
    )


def read_crossings(table: Table, folder: Path) -> Crossings:
    """``crossings``: the least and the greatest ``speed``, m/s; perhaps how many ``cylinders`` at least and
    at most, and the ``legs`` of their ways.
    """
    table.allow_only("crossings")
    part = table.table("crossings")
    part.allow_only("speed", "cylinders", "legs")
    slowest, fastest = part.numbers("speed", "least, greatest")
    part.check(0.0 < slowest <= fastest <= 5.0, "speed", "two speeds up to 5 m/s, the lesser first")
    fewest, most = part.numbers("cylinders", "least, most") if "cylinders" in part else (FEWEST, MOST)
    are_counts = fewest == int(fewest) and most == int(most) and 0 <= fewest <= most <= MOST_CYLINDERS
    part.check(are_counts, "cylinders", f"two counts up to {MOST_CYLINDERS}, the lesser first")
    legs = part.count("legs", 1)
    part.check(legs <= MOST_LEGS, "legs", f"at most {MOST_LEGS}")
    return Crossings(slowest, fastest, int(fewest), int(most), legs)
