#!/usr/bin/env python3
"""Makes long logs of large buildings, with relations from the truth, for the benchmark ``slam.py`` to score.

As in the logs of the Freiburg benchmark, a laser of 180 degrees and 180 beams measures to the centimetre five
times a second, people walk by, and the odometry's heading drifts. Relations tie each place to the next one
and to the ones where the robot had been before.

    python3 tests/benchmarks/slam_logs.py runs/long_logs --seed 0
    python3 tests/benchmarks/slam.py runs/long_logs --out runs/slam_long
"""

import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterator, List, Optional, Tuple

import numpy as np
from helpers.bags import START, write_bag
from helpers.drives import Sighting

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, Scan, wrap
from planar.geometry.ray_casting import cast_rays

RESOLUTION, WALL, CORRIDOR, DOOR = 0.025, 0.15, 2.2, 0.95
PERIOD, SPEED, TURN_SPEED = 0.2, 0.5, 0.7
LASER_IN_BASE = Pose2(0.1, 0.0, 0.0)
BEAMS, RANGE_MAX, SIGHT, RANGE_NOISE = 180, 80.0, 30.0, 0.015
# Who walks by: how wide, how fast at most, how near at first, for how many scans, one of how many may come.
PERSON_RADIUS, PERSON_SPEED, PERSON_RANGES, PERSON_SCANS, PERSON_ODDS = 0.25, 1.2, (1.0, 5.0), 25, 3
RELATION_STEP, REVISIT_RADIUS, REVISIT_SECONDS = 1.0, 2.0, 60.0


@dataclass(frozen=True)
class Building:
    """``columns`` x ``rows`` blocks of rooms, each ``block`` metres (x, y), with corridors around them.

    ``visits``: share of the rooms passed that the robot looks into. Odometry's heading errs by ``turn_error``
    radians per radian, ``way_error`` radians per metre, and at random.
    """

    columns: int
    rows: int
    block: Tuple[float, float]
    room_width: Tuple[float, float]
    visits: float
    scans: int
    turn_error: float
    way_error: float


BUILDINGS: Dict[str, Building] = {
    "offices": Building(1, 1, (22.0, 18.0), (3.0, 5.0), 0.8, 13700, 0.04, 0.004),
    "corridors": Building(3, 2, (42.0, 26.0), (4.0, 9.0), 0.03, 12000, 0.02, 0.003),
    "wing": Building(2, 1, (30.0, 14.0), (3.0, 6.0), 0.5, 9000, 0.06, 0.01),
}


class Site:
    """A building as it was built from a seed: the true ``grid``, and where a robot can go."""

    def __init__(self, plan: Building, rng: np.random.Generator):
        self._rng = rng
        self._pitch = np.array(plan.block) + CORRIDOR
        self._size = self._pitch * [plan.columns, plan.rows] + CORRIDOR
        shape = np.ceil((self._size + 2.0 * WALL) / RESOLUTION).astype(int)[::-1]
        self._cells = np.zeros(shape, dtype=np.int8)
        width, depth = self._size
        self._fill(-WALL, -WALL, width + WALL, depth + WALL)
        self._fill(0.0, 0.0, width, depth, FREE)
        # Inside each room, the way (3, 2) from the corridor in.
        self.rooms: List[np.ndarray] = []
        for column in range(plan.columns):
            for row in range(plan.rows):
                self._build_block(CORRIDOR + self._pitch * [column, row], plan)
        self.grid = OccupancyGrid(self._cells, RESOLUTION, Pose2(-WALL, -WALL, 0.0))
        self.crossings = np.array([(i, j) for i in range(plan.columns + 1) for j in range(plan.rows + 1)])

    def crossing_xy(self, crossing) -> np.ndarray:
        """Where two corridors meet."""
        return self._pitch * crossing + 0.5 * CORRIDOR

    def _build_block(self, corner: np.ndarray, plan: Building) -> None:
        width, depth = plan.block
        self._fill(*corner, *(corner + plan.block))
        x = 0.0
        while x < width - plan.room_width[0]:
            room = min(self._rng.uniform(*plan.room_width), width - x)
            middle = depth * self._rng.uniform(0.4, 0.6)
            self._build_room(corner + [x, 0.0], room, middle, upwards=True)
            self._build_room(corner + [x, depth], room, depth - middle, upwards=False)
            x += room

    def _build_room(self, corner: np.ndarray, width: float, depth: float, upwards: bool) -> None:
        """A room whose door is in the wall along x through ``corner``, with furniture beside the way in."""
        sign = 1.0 if upwards else -1.0
        self._fill_room(corner, sign, (WALL, WALL, width - WALL, depth - WALL), 0)
        door = self._rng.uniform(0.3, max(width - DOOR - 0.3, 0.31))
        self._fill_room(corner, sign, (door, 0.0, door + DOOR, WALL), 0)
        way_x = door + 0.5 * DOOR
        inside = self._rng.uniform(1.0, max(depth - 1.0, 1.1))
        for _ in range(self._rng.integers(2, 6)):
            x, y = self._rng.uniform(WALL, width - WALL), self._rng.uniform(WALL, depth - WALL)
            size = self._rng.uniform(0.2, 1.2, 2)
            if abs(x - way_x) > 0.5 * size[0] + 0.45 or y - 0.5 * size[1] > inside + 0.5:
                box = (max(x - 0.5 * size[0], 0.0), max(y - 0.5 * size[1], 0.0))
                self._fill_room(
                    corner, sign, (*box, min(x + 0.5 * size[0], width), min(y + 0.5 * size[1], depth))
                )
        way = [(way_x, -0.5 * CORRIDOR), (way_x, 0.0), (way_x, inside)]
        self.rooms.append(corner + np.array(way) * [1.0, sign])

    def _fill_room(self, corner: np.ndarray, sign: float, box, value: int = OCCUPIED) -> None:
        x0, y0, x1, y1 = box
        ys = sorted((corner[1] + sign * y0, corner[1] + sign * y1))
        self._fill(corner[0] + x0, ys[0], corner[0] + x1, ys[1], value)

    def _fill(self, x0: float, y0: float, x1: float, y1: float, value: int = OCCUPIED) -> None:
        col, row, end_col, end_row = (round((v + WALL) / RESOLUTION) for v in (x0, y0, x1, y1))
        self._cells[row:end_row, col:end_col] = value


def walk(site: Site, plan: Building, rng: np.random.Generator) -> Iterator[np.ndarray]:
    """Places (x, y) to go to without end: along corridors, into rooms on the way, seldom straight back."""
    last, here = None, np.array([0, 0])
    yield site.crossing_xy(here)
    while True:
        near = site.crossings[np.abs(site.crossings - here).sum(axis=1) == 1]
        onward = [crossing for crossing in near if last is None or (crossing != last).any()]
        last, here = here, onward[rng.integers(len(onward))]
        start, end = site.crossing_xy(last), site.crossing_xy(here)
        if start[1] == end[1]:
            yield from _into_rooms(site, start, end, plan.visits, rng)
        yield end


def _into_rooms(site: Site, start, end, share: float, rng) -> Iterator[np.ndarray]:
    low, high = sorted((start[0], end[0]))
    passed = [way for way in site.rooms if abs(way[0, 1] - start[1]) < 0.1 and low < way[0, 0] < high]
    for way in sorted(passed, key=lambda way: abs(way[0, 0] - start[0])):
        if rng.random() < share:
            yield from way
            yield from way[-2::-1]


def true_poses(places: Iterator[np.ndarray], count: int, rng: np.random.Generator) -> Iterator[Pose2]:
    """The way of a robot that turns on the spot and drives straight on, swaying a little."""
    x, y = next(places)
    yaw, n = 0.0, 0
    for goal_x, goal_y in places:
        while math.hypot(goal_x - x, goal_y - y) > 0.1:
            bearing = wrap(math.atan2(goal_y - y, goal_x - x) - yaw)
            turn = float(np.clip(bearing, -TURN_SPEED * PERIOD, TURN_SPEED * PERIOD))
            yaw = wrap(yaw + turn + rng.normal(0.0, 0.01))
            step = SPEED * PERIOD * max(0.0, 1.0 - 3.0 * abs(bearing))
            x, y = x + step * math.cos(yaw), y + step * math.sin(yaw)
            yield Pose2(x, y, yaw)
            n += 1
            if n == count:
                return


class DriftingOdometry:
    """Wheel odometry with errors in proportion to turn and way, and random ones."""

    def __init__(self, plan: Building, rng: np.random.Generator):
        self._plan, self._rng, self._pose = plan, rng, Pose2()

    def move(self, motion: Pose2) -> Pose2:
        """The pose believed after a true ``motion``."""
        way = math.hypot(motion.x, motion.y)
        slip = 1.0 + self._rng.normal(0.02, 0.05)
        drift = self._plan.turn_error * motion.yaw + self._plan.way_error * way
        drift += self._rng.normal(0.0, 0.01 * math.sqrt(way + abs(motion.yaw)))
        self._pose = self._pose @ Pose2(slip * motion.x, slip * motion.y, motion.yaw + drift)
        return self._pose


class Person:
    """Somebody who walks straight on through the robot's sight for a while; then perhaps another."""

    def __init__(self, rng: np.random.Generator):
        self._rng = rng
        self._scans_left = 0
        self._is_there = False

    def hide(self, ranges: np.ndarray, laser: Pose2, angles: np.ndarray) -> None:
        """Shortens the readings (N,) of the beams that the person is in the way of; one scan goes by."""
        if self._scans_left == 0:
            self._scans_left = PERSON_SCANS
            self._is_there = self._rng.integers(PERSON_ODDS) == 0
            away, distance = self._rng.uniform(-1.0, 1.0), self._rng.uniform(*PERSON_RANGES)
            start = laser @ Pose2(distance * math.cos(away), distance * math.sin(away))
            self._xy = np.array([start.x, start.y])
            self._step = self._rng.uniform(-1.0, 1.0, 2) * PERSON_SPEED * PERIOD
        self._scans_left -= 1
        self._xy = self._xy + self._step
        if self._is_there:
            x, y = laser.inverse().transform_points(self._xy[None])[0]
            along = x * np.cos(angles) + y * np.sin(angles)
            beside = np.abs(y * np.cos(angles) - x * np.sin(angles))
            met = (along > 0.3) & (beside < PERSON_RADIUS)
            front = along[met] - np.sqrt(PERSON_RADIUS**2 - beside[met] ** 2)
            ranges[met] = np.minimum(ranges[met], front)


def sightings_of(site: Site, poses: Iterator[Pose2], plan: Building, rng) -> Iterator[Sighting]:
    """What the robot measures on its way."""
    angles = -0.5 * math.pi + math.pi / BEAMS * np.arange(BEAMS)
    odometry, person = DriftingOdometry(plan, rng), Person(rng)
    last: Optional[Pose2] = None
    for i, pose in enumerate(poses):
        in_odom = odometry.move(Pose2() if last is None else last.inverse() @ pose)
        last, laser = pose, pose @ LASER_IN_BASE
        ranges = cast_rays(site.grid, laser, angles, RANGE_MAX)
        person.hide(ranges, laser, angles)
        ranges += rng.normal(0.0, RANGE_NOISE, BEAMS)
        ranges[ranges > SIGHT] = RANGE_MAX
        readings = np.round(ranges, 2).astype(np.float32)
        step = angles[1] - angles[0]
        scan = Scan(i * PERIOD, angles[0], step, readings, 0.1, RANGE_MAX, laser_in_base=LASER_IN_BASE)
        yield Sighting(scan, in_odom, pose)


def relations_of(sightings: List[Sighting]) -> np.ndarray:
    """Rows ``t1 t2 x y z roll pitch yaw`` of the laser: to the place before, and to earlier visits."""
    rows: List[Tuple[float, ...]] = []
    places: List[Tuple[float, Pose2]] = []
    for sighting in sightings:
        laser = sighting.base_in_map @ sighting.scan.laser_in_base
        if places and places[-1][1].distance_to(laser) < RELATION_STEP:
            continue
        stamp = START + sighting.scan.stamp
        rows += [_relation(place, (stamp, laser)) for place in places[-1:]]
        visits = [place for place in places if place[0] < stamp - REVISIT_SECONDS]
        again = [place for place in visits if place[1].distance_to(laser) < REVISIT_RADIUS]
        rows += [_relation(place, (stamp, laser)) for place in again[:1] + again[-1:]]
        places.append((stamp, laser))
    return np.array(rows)


def _relation(earlier: Tuple[float, Pose2], later: Tuple[float, Pose2]) -> Tuple[float, ...]:
    (t1, first), (t2, second) = earlier, later
    x, y, yaw = (first.inverse() @ second).as_array()
    return t1, t2, x, y, 0.0, 0.0, 0.0, yaw


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, help="where the bags and relations go")
    parser.add_argument("--seed", type=int, default=0, help="of building, way and noise (default: 0)")
    parser.add_argument("--only", choices=BUILDINGS, help="make this one")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    for name, plan in BUILDINGS.items():
        if options.only in (None, name):
            rng = np.random.default_rng([options.seed, len(name)])
            site = Site(plan, rng)
            poses = true_poses(walk(site, plan, rng), plan.scans, rng)
            sightings = list(sightings_of(site, poses, plan, rng))
            write_bag(options.folder / f"{name}.bag", sightings, base_frame="base_link")
            relations = relations_of(sightings)
            np.savetxt(options.folder / f"{name}.relations", relations, fmt="%.6f")
            print(f"{name}: {len(sightings)} scans, {len(relations)} relations")
    return 0


if __name__ == "__main__":
    sys.exit(main())
