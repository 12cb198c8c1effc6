#!/usr/bin/env python3
"""Multi-session mapping in a home whose furniture moves, and missions on the last map.

Each session starts at another place, without an initial pose, with half of the furniture moved, and resumes
the state saved by the one before.

    python3 tests/benchmarks/slam_sessions.py --sessions 10 --seed 100 --mission map/mission.yaml

Seeds below 100 are for choosing settings, from 100 on for evaluation.
"""

import argparse
import json
import math
import sys
import time
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Iterator, List, Sequence, Tuple

import numpy as np
from helpers.drives import Observation, Tour, drive
from scipy.ndimage import label

from evaluation.map_truth import score_against_world
from headless_mission import HeadlessMission
from pick_objects import load_mission
from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, save_map
from planar.config.parameters import settings_from_yaml
from planar.geometry.distance_field import distance_field
from planar_ros.node.entry import use_one_blas_thread
from sim_bridge import load_world, robot_named
from sim_bridge.simulation import box_on_floor
from sim_bridge.views.true_map import true_map
from sim_bridge.world import World
from slam_lite.config import NodeSettings
from slam_lite.mapper import Mapper
from slam_lite.state import load_state, save_state

ROOT = Path(__file__).resolve().parents[2]
SLAM_CONFIG = ROOT / "src/slam_lite/config/turtlebot.yaml"
# Furniture: number of pieces, sizes [m], probability of a move, and distances from walls, places and pieces
# [m].
PIECES, SIZES, MOVES, TO_WALL, TO_PLACES, TO_OTHERS = 8, (0.3, 0.7), 0.5, 0.55, 1.0, 1.1
# Free space that a path needs to each side [m]; least share of the home that stays reachable; number of
# places tried for a piece of furniture.
PATH_CLEARANCE, OPEN_SHARE, TRIES = 0.35, 0.98, 200
# Error up to which the mapper counts as localized [m].
FOUND = 0.3


@dataclass(frozen=True)
class Session:
    """One session: size of the state, errors of the new keyframes, and quality of the map."""

    session: int
    keyframes: int
    kilobytes: float
    found_after: float
    mean_error: float
    max_error: float
    recall: float
    precision: float
    doubled_walls: int
    stale_pieces: int
    cpu_seconds: float


Piece = Tuple[Pose2, Tuple[float, float, float]]


class Home:
    """A world with furniture that moves between sessions, and never blocks a part of it."""

    def __init__(self, world: World, height: float, places: Sequence[Pose2], seed: int):
        self._world, self._rng = world, np.random.default_rng([seed, 18])
        self._grid = true_map(world, height)
        self._clearance = distance_field(self._grid.cells != FREE, self._grid.resolution)
        self._places = [(place.x, place.y) for place in places]
        self._reachable_cells = self._reached(self._clearance > PATH_CLEARANCE)
        self._pieces: List[Piece] = []
        for _ in range(PIECES):
            self._pieces.append(self._placed([pose for pose, _ in self._pieces], self._pieces))

    def move(self) -> List[Pose2]:
        """Move some pieces; return their former poses."""
        left: List[Pose2] = []
        for i, (pose, _) in enumerate(self._pieces):
            if self._rng.random() < MOVES:
                left.append(pose)
                standing = [*self._pieces[:i], *self._pieces[i + 1 :]]
                self._pieces[i] = self._placed([*left, *(other for other, _ in standing)], standing)
        return left

    def world(self) -> World:
        """Return the world with the furniture."""
        boxes = [box_on_floor(f"piece_{i}", size, pose) for i, (pose, size) in enumerate(self._pieces)]
        return replace(self._world, bodies=(*self._world.bodies, *boxes))

    def start(self) -> Pose2:
        """Return a free pose to start at."""
        return self._free_place([pose for pose, _ in self._pieces])

    def _placed(self, others: Sequence[Pose2], standing: Sequence[Piece]) -> Piece:
        """Place a new piece, away from ``others``, that blocks no path together with those ``standing``."""
        width, depth = (float(side) for side in self._rng.uniform(*SIZES, size=2))
        for _ in range(TRIES):
            piece = self._free_place(others), (width, depth, 0.6)
            if self._is_open([*standing, piece]):
                return piece
        raise SystemExit(f"error: no place for a piece of furniture in {TRIES} tries")

    def _is_open(self, pieces: Sequence[Piece]) -> bool:
        """Whether nearly all free cells stay reachable."""
        free = self._reachable_cells.copy()
        ways = np.argwhere(free)
        points_xy = self._grid.points_of(ways)
        for pose, (width, depth, _) in pieces:
            is_blocked = np.hypot(*(points_xy - (pose.x, pose.y)).T) < PATH_CLEARANCE + 0.5 * math.hypot(
                width, depth
            )
            free[tuple(ways[is_blocked].T)] = False
        return np.count_nonzero(self._reached(free)) > OPEN_SHARE * np.count_nonzero(free)

    def _reached(self, free: np.ndarray) -> np.ndarray:
        """The ``free`` cells that are reachable from the home's origin."""
        parts, _ = label(free)
        row, col = self._grid.cells_of([(0.0, 0.0)])[0]
        return (parts == parts[row, col]) & free

    def _free_place(self, others: Sequence[Pose2]) -> Pose2:
        spots = self._grid.points_of(np.argwhere(self._clearance > TO_WALL))
        kept = [(xy, TO_PLACES) for xy in [(0.0, 0.0), *self._places]]
        for xy, apart in [*kept, *(((pose.x, pose.y), TO_OTHERS) for pose in others)]:
            spots = spots[np.hypot(*(spots - xy).T) > apart]
        x, y = spots[self._rng.integers(len(spots))]
        return Pose2(float(x), float(y), float(self._rng.uniform(-math.pi, math.pi)))


def main() -> int:
    use_one_blas_thread()
    options = _options()
    mission = load_mission(options.mission)
    robot = robot_named(options.robot)
    height = float(robot.laser.pose_in_base[2, 3])
    places = [place.pose for place in mission.places.values()]
    home = Home(load_world(ROOT / "map/home.world"), height, places, options.seed)
    options.out.mkdir(parents=True, exist_ok=True)
    state = options.out / "home.npz"
    state.unlink(missing_ok=True)
    sessions: List[Session] = []
    left: List[Pose2] = []
    for number in range(options.sessions):
        left = home.move() if number else left
        world = home.world()
        start = home.start() if number else Pose2()
        grid = true_map(world, height)
        tour = Tour(grid, *_reachable(grid, places))
        observations = drive(
            world, tour, options.seed * 100 + number, options.seconds, start=start, robot=options.robot
        )
        session, mapped = _map(number, observations, state)
        score = score_against_world(mapped, world, robot)
        stale = sum(_is_drawn(mapped, pose) for pose in left)
        session = replace(session, **asdict(score), stale_pieces=stale)
        sessions.append(session)
        print(_line(session, len(left)), flush=True)
        save_map(mapped, options.out / f"session_{number}")
    (options.out / "sessions.json").write_text(json.dumps([asdict(one) for one in sessions], indent=2) + "\n")
    verdicts = [
        HeadlessMission(world, robot, mapped, mission, options.seed + i).run().verdict
        for i in range(options.missions)
    ]
    for verdict in verdicts:
        print(f"mission on the last map: {'SUCCESS' if verdict.success else 'FAILURE'}: {verdict.reason}")
    return 0 if all(verdict.success for verdict in verdicts) else 1


def _map(number: int, observations: List[Observation], path: Path) -> Tuple[Session, OccupancyGrid]:
    """Map one session, resuming the state at ``path`` if there is one, and save the new one there."""
    start = time.process_time()
    settings, _ = settings_from_yaml(NodeSettings, SLAM_CONFIG)
    mapper = Mapper(settings)
    if number:
        mapper.resume(load_state(path))
    true_keyframes, found_after = [], math.nan
    for observation in observations:
        update = mapper.insert(observation.base_in_odom, observation.scan)
        if update is None:
            continue
        if math.isnan(found_after) and update.base_in_map.distance_to(observation.base_in_map) < FOUND:
            found_after = observation.scan.stamp - observations[0].scan.stamp
        if update.is_keyframe:
            true_keyframes.append(observation.base_in_map.as_array()[:2])
    mapper.run_final_optimization()
    grid = mapper.grid()
    cpu_seconds = time.process_time() - start
    save_state(mapper.state(), path)
    errors = np.hypot(*(mapper.keyframe_poses[-len(true_keyframes) :, :2] - np.array(true_keyframes)).T)
    session = Session(
        number,
        len(mapper.keyframe_poses),
        path.stat().st_size / 1000.0,
        found_after,
        float(errors.mean()),
        float(errors.max()),
        recall=0.0,
        precision=0.0,
        doubled_walls=0,
        stale_pieces=0,
        cpu_seconds=cpu_seconds,
    )
    return session, grid


def _reachable(grid: OccupancyGrid, places: Sequence[Pose2]) -> Iterator[Tuple[float, float]]:
    """For each place the nearest one with enough clearance for the driver."""
    clearance = distance_field(grid.cells == OCCUPIED, grid.resolution)
    free = grid.points_of(np.argwhere((clearance > 0.35) & (grid.cells == FREE)))
    for place in places:
        x, y = free[np.argmin(np.hypot(*(free - (place.x, place.y)).T))]
        yield float(x), float(y)


def _is_drawn(grid: OccupancyGrid, piece: Pose2) -> bool:
    """Whether the map still has obstacles at the former pose of a piece of furniture."""
    occupied = grid.points_of(np.argwhere(grid.cells == OCCUPIED))
    return bool((np.hypot(*(occupied - (piece.x, piece.y)).T) < TO_WALL - 0.1).any())


def _line(one: Session, moved: int) -> str:
    return (
        f"session {one.session}: {one.keyframes} keyframes, {one.kilobytes:.0f} kB, "
        f"localized after {one.found_after:.1f} s, "
        f"keys off by {one.mean_error:.3f} m (at most {one.max_error:.3f}), recall {one.recall:.3f}, "
        f"precision {one.precision:.3f}, {one.doubled_walls} doubled walls, "
        f"{one.stale_pieces} of {moved} moved pieces still drawn, {one.cpu_seconds:.0f} s of CPU"
    )


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sessions", type=int, default=10, help="default: 10")
    parser.add_argument("--seed", type=int, default=0, help="of furniture, starts and noise (default: 0)")
    parser.add_argument("--seconds", type=float, default=180.0, help="of a session, simulated (default: 180)")
    parser.add_argument("--robot", default="turtlebot_lidar", help="profile (default: turtlebot_lidar)")
    parser.add_argument(
        "--mission", type=Path, default=ROOT / "map/mission.yaml", help="default: map/mission.yaml"
    )
    parser.add_argument("--missions", type=int, default=3, help="how many are driven at the end (default: 3)")
    parser.add_argument("--out", type=Path, default=Path("runs/sessions"), help="default: runs/sessions")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
