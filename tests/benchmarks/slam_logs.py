#!/usr/bin/env python3
"""Simulate long logs of large buildings and sites, with relations from ground truth, for ``slam.py``.

As in the logs of the Freiburg benchmark, a laser of 180 degrees and 180 beams measures to the centimetre,
people walk by, and the odometry's heading drifts. Relations connect each place with the next one and with
earlier visits.

    python3 tests/benchmarks/slam_logs.py runs/long_logs --seed 0
    python3 tests/benchmarks/slam.py runs/long_logs --out runs/slam_long

Seeds below 100 are for choosing settings, from 100 on for evaluation.
"""

import argparse
import math
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Dict, Iterator, List, Optional, Tuple, Union

import numpy as np
from helpers.bags import START, write_bag
from helpers.drives import Observation
from helpers.gardens import Garden
from helpers.sites import Building, Campus, House

from planar import OccupancyGrid, Pose2, Scan, wrap
from planar.geometry.ray_casting import cast_rays

SPEED, TURN_SPEED = 0.5, 0.7
LASER_IN_BASE = Pose2(0.1, 0.0, 0.0)
BEAMS, RANGE_MAX, RANGE_NOISE = 180, 80.0, 0.015
# A person who walks by: radius, largest speed, initial range, number of scans, and one of how many appears.
PERSON_RADIUS, PERSON_SPEED, PERSON_RANGES, PERSON_SCANS, PERSON_ODDS = 0.25, 1.2, (1.0, 5.0), 25, 3
# A wheel slip: largest error of distance [m] and heading [rad].
SLIP_DISTANCE, SLIP_TURN = 0.3, 0.15
RELATION_STEP, REVISIT_RADIUS, REVISIT_SECONDS = 1.0, 2.0, 60.0
SITE_SIZE, SITE_SLOTS = (500.0, 300.0), (3, 2)
# A site with hedges, and largest turn between two of its scans [rad], as in logs of sparse scans.
GARDEN_SIZE, GARDEN_SLOTS, MAX_TURN = (260.0, 180.0), (2, 2), 0.5
# Pauses of the recording: number, duration [s], and how many scans of the drive are missing in each.
PAUSES, PAUSE_SECONDS, PAUSE_SCANS = 3, (60.0, 240.0), (1, 6)
CART_RADIUS, CART_SHARE = 0.5, 0.3


@dataclass(frozen=True)
class Drive:
    """A simulated drive.

    Attributes:
        buildings: One building, or several on a campus.
        scans: Number of scans.
        turn_error: Bias of odometry's heading [rad/rad].
        distance_error: Bias of odometry's heading [rad/m].
        period: Time between scans [s].
        max_range: Range beyond which the laser has no return [m].
        people: Number of people who walk by.
        slip_distance: Mean distance between wheel slips [m].
        beams: Number of beams of the laser.
        has_garden: Whether hedges, poles, cars that move and pauses are added, and some people push carts.
        random_error: Random errors of odometry, as a multiple of those of the other drives.
    """

    buildings: Tuple[Building, ...]
    scans: int
    turn_error: float
    distance_error: float
    period: float = 0.2
    max_range: float = 30.0
    people: int = 1
    slip_distance: float = math.inf
    beams: int = BEAMS
    has_garden: bool = False
    random_error: float = 1.0

    @property
    def is_campus(self) -> bool:
        """Whether there are several buildings."""
        return len(self.buildings) > 1


DRIVES: Dict[str, Drive] = {
    "offices": Drive((Building(1, 1, (22.0, 18.0), (3.0, 5.0), 0.8),), 13700, 0.04, 0.004),
    "corridors": Drive((Building(3, 2, (42.0, 26.0), (4.0, 9.0), 0.03),), 12000, 0.02, 0.003),
    "wing": Drive((Building(2, 1, (30.0, 14.0), (3.0, 6.0), 0.5),), 9000, 0.06, 0.01),
    "repetitive": Drive(
        (Building(3, 3, (30.0, 16.0), (5.0, 5.0), 0.05, is_repetitive=True),), 4500, 0.03, 0.004, period=0.5
    ),
}


def site_drive(rng: np.random.Generator) -> Drive:
    """A drive of some 2.5 km over a random site of 500 m x 300 m with four to six buildings."""
    buildings = [
        Building(
            int(rng.integers(1, 4)),
            int(rng.integers(1, 3)),
            (rng.uniform(22.0, 40.0), rng.uniform(14.0, 26.0)),
            (rng.uniform(3.0, 5.0), rng.uniform(5.0, 9.0)),
            rng.uniform(0.0, 0.15),
        )
        for _ in range(rng.integers(4, 7))
    ]
    errors = rng.uniform(0.02, 0.06), rng.uniform(0.002, 0.006)
    max_range = float(rng.choice([20.0, 50.0, 80.0]))
    return Drive(
        tuple(buildings), 20000, *errors, period=0.7, max_range=max_range, people=3, slip_distance=300.0
    )


def garden_drive(rng: np.random.Generator) -> Drive:
    """A drive of some 1.5 km past hedges, fences, glass, poles and people, between two to four buildings.

    Odometry is as good as that of real robots or worse, the beams are as many as those of common lasers.
    """
    buildings = [
        Building(
            int(rng.integers(1, 3)),
            int(rng.integers(1, 3)),
            (rng.uniform(20.0, 28.0), rng.uniform(12.0, 18.0)),
            (rng.uniform(3.0, 5.0), rng.uniform(5.0, 9.0)),
            rng.uniform(0.0, 0.15),
        )
        for _ in range(rng.integers(2, 5))
    ]
    is_good = rng.random() < 0.6
    turn_error, distance_error = (0.01, 0.001) if is_good else (rng.uniform(0.02, 0.06), 0.004)
    return Drive(
        tuple(buildings),
        6000,
        turn_error,
        distance_error,
        period=float(rng.choice([0.8, 1.4])),
        max_range=float(rng.choice([30.0, 80.0])),
        people=int(rng.integers(3, 10)),
        slip_distance=math.inf if is_good else 300.0,
        beams=int(rng.choice([180, 361])),
        has_garden=True,
        random_error=0.4 if is_good else 1.0,
    )


DRAWN = {"site": site_drive, "hedges": garden_drive}


def simulate(name: str, seed: int) -> Tuple[OccupancyGrid, Drive, List[Observation]]:
    """Return the true grid, the drive and the observations of a log; each seed is another "site"."""
    rng = np.random.default_rng([seed, len(name)])
    drive = DRIVES[name] if name in DRIVES else DRAWN[name](rng)
    if drive.has_garden:
        campus = Campus(drive.buildings, GARDEN_SLOTS, GARDEN_SIZE, rng)
        poses = true_poses(campus.walk(rng, again=8), drive, rng)
        observations = list(observations_of(Garden(campus, rng), poses, drive, rng))
        return campus.grid, drive, with_pauses(observations, rng)
    site: Union[Campus, House]
    if drive.is_campus:
        site = Campus(drive.buildings, SITE_SLOTS, SITE_SIZE, rng)
    else:
        site = House(drive.buildings[0], rng)
    poses = true_poses(site.walk(rng), drive, rng)
    return site.grid, drive, list(observations_of(site.grid, poses, drive, rng))


def with_pauses(observations: List[Observation], rng: np.random.Generator) -> List[Observation]:
    """Drop a few scans in a row, some times, and delay what follows by minutes."""
    starts = np.sort(rng.integers(len(observations) // 10, len(observations) - 10, PAUSES))
    kept, delay, resume = [], 0.0, 0
    for i, one in enumerate(observations):
        if i in starts:
            resume = i + int(rng.integers(*PAUSE_SCANS))
            delay += rng.uniform(*PAUSE_SECONDS)
        if i >= resume:
            kept.append(replace(one, scan=replace(one.scan, stamp=one.scan.stamp + delay)))
    return kept


def true_poses(places: Iterator[np.ndarray], drive: Drive, rng: np.random.Generator) -> Iterator[Pose2]:
    """Poses of a robot that turns in place and drives straight, swaying a little."""
    x, y = next(places)
    yaw, n = 0.0, 0
    for goal_x, goal_y in places:
        while math.hypot(goal_x - x, goal_y - y) > 0.5 * SPEED * drive.period + 0.05:
            bearing = wrap(math.atan2(goal_y - y, goal_x - x) - yaw)
            most = min(TURN_SPEED * drive.period, MAX_TURN)
            turn = float(np.clip(bearing, -most, most))
            yaw = wrap(yaw + turn + rng.normal(0.0, 0.01))
            step = SPEED * drive.period * max(0.0, 1.0 - 3.0 * abs(bearing))
            x, y = x + step * math.cos(yaw), y + step * math.sin(yaw)
            yield Pose2(x, y, yaw)
            n += 1
            if n == drive.scans:
                return


class DriftingOdometry:
    """Wheel odometry with bias, random errors and slips."""

    def __init__(self, drive: Drive, rng: np.random.Generator):
        self._drive, self._rng, self._pose = drive, rng, Pose2()

    def move(self, motion: Pose2) -> Pose2:
        """Return the odometry pose after a true ``motion``."""
        distance = math.hypot(motion.x, motion.y)
        random_error = self._drive.random_error
        slip = 1.0 + random_error * self._rng.normal(0.02, 0.05)
        drift = self._drive.turn_error * motion.yaw + self._drive.distance_error * distance
        drift += self._rng.normal(0.0, random_error * 0.01 * math.sqrt(distance + abs(motion.yaw)))
        if self._drive.slip_distance < math.inf and self._rng.random() * self._drive.slip_distance < distance:
            motion = motion @ Pose2(-self._rng.uniform(0.0, SLIP_DISTANCE), 0.0)
            drift += self._rng.uniform(-SLIP_TURN, SLIP_TURN)
        self._pose = self._pose @ Pose2(slip * motion.x, slip * motion.y, motion.yaw + drift)
        return self._pose


class Person:
    """A person who walks straight past the robot for a while; then perhaps another."""

    def __init__(self, period: float, rng: np.random.Generator, radius: float = PERSON_RADIUS):
        self._period, self._rng, self._radius = period, rng, radius
        self._scans_left = 0
        self._is_there = False

    def hide(self, ranges: np.ndarray, laser: Pose2, angles: np.ndarray) -> None:
        """Shorten the readings (N,) of the beams that hit the person, and advance by one scan."""
        if self._scans_left == 0:
            self._scans_left = PERSON_SCANS
            self._is_there = self._rng.integers(PERSON_ODDS) == 0
            away, distance = self._rng.uniform(-1.0, 1.0), self._rng.uniform(*PERSON_RANGES)
            start = laser @ Pose2(distance * math.cos(away), distance * math.sin(away))
            self._xy = np.array([start.x, start.y])
            self._step = self._rng.uniform(-1.0, 1.0, 2) * PERSON_SPEED * self._period
        self._scans_left -= 1
        self._xy = self._xy + self._step
        if self._is_there:
            x, y = laser.inverse().transform_points(self._xy[None])[0]
            along = x * np.cos(angles) + y * np.sin(angles)
            beside = np.abs(y * np.cos(angles) - x * np.sin(angles))
            met = (along > 0.3) & (beside < self._radius)
            front = along[met] - np.sqrt(self._radius**2 - beside[met] ** 2)
            ranges[met] = np.minimum(ranges[met], front)


def observations_of(
    place: Union[OccupancyGrid, Garden], poses: Iterator[Pose2], drive: Drive, rng: np.random.Generator
) -> Iterator[Observation]:
    """Simulate the laser and odometry along the true poses."""
    angles = -0.5 * math.pi + math.pi / drive.beams * np.arange(drive.beams)
    carts = round(CART_SHARE * drive.people) if drive.has_garden else 0
    radii = [CART_RADIUS if number < carts else PERSON_RADIUS for number in range(drive.people)]
    odometry, people = DriftingOdometry(drive, rng), [Person(drive.period, rng, radius) for radius in radii]
    last: Optional[Pose2] = None
    for i, pose in enumerate(poses):
        in_odom = odometry.move(Pose2() if last is None else last.inverse() @ pose)
        last, laser = pose, pose @ LASER_IN_BASE
        if isinstance(place, Garden):
            ranges = place.ranges(laser, angles, RANGE_MAX, 2 * i > drive.scans // 2, rng)
        else:
            ranges = cast_rays(place, laser, angles, RANGE_MAX)
        for person in people:
            person.hide(ranges, laser, angles)
        ranges += rng.normal(0.0, RANGE_NOISE, drive.beams)
        ranges[ranges > drive.max_range] = RANGE_MAX
        readings = np.round(ranges, 2).astype(np.float32)
        step = angles[1] - angles[0]
        scan = Scan(i * drive.period, angles[0], step, readings, 0.1, RANGE_MAX, laser_in_base=LASER_IN_BASE)
        yield Observation(scan, in_odom, pose)


def relations_of(observations: List[Observation]) -> np.ndarray:
    """Rows ``t1 t2 x y z roll pitch yaw`` of the laser: to the last place, and to earlier visits."""
    rows: List[Tuple[float, ...]] = []
    places: List[Tuple[float, Pose2]] = []
    for observation in observations:
        laser = observation.base_in_map @ observation.scan.laser_in_base
        if places and places[-1][1].distance_to(laser) < RELATION_STEP:
            continue
        stamp = START + observation.scan.stamp
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
    parser.add_argument("folder", type=Path, help="output folder of bags and relations")
    parser.add_argument("--seed", type=int, default=0, help="of building, route and noise (default: 0)")
    parser.add_argument("--only", choices=[*DRIVES, *DRAWN], help="simulate only this one")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    for name in [options.only] if options.only else [*DRIVES, *DRAWN]:
        _, _, observations = simulate(name, options.seed)
        write_bag(options.folder / f"{name}.bag", observations, base_frame="base_link")
        relations = relations_of(observations)
        np.savetxt(options.folder / f"{name}.relations", relations, fmt="%.6f")
        print(f"{name}: {len(observations)} scans, {len(relations)} relations")
    return 0


if __name__ == "__main__":
    sys.exit(main())
