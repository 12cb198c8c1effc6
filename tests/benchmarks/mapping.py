#!/usr/bin/env python3
"""Autonomous mapping of a world: map_home.sh in one process, for several seeds.

Simulation, Mapper, Explorer and Navigator are stepped together; each map is scored against the true grid, and
a mission is simulated on it.

    python3 tests/benchmarks/mapping.py --seeds 100-119 --mission map/mission.yaml
    python3 tests/benchmarks/mapping.py --world FILE --robot turtlebot_kinect --maps runs/maps
"""

import argparse
import json
import math
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import List, Optional

import numpy as np
from helpers.command_line import seeds

from evaluation.map_truth import LEAST_PRECISION, LEAST_RECALL, score_against_world
from evaluation.verdict import ARRIVAL_TOLERANCE
from explorer_lite import Explorer, ExplorerSettings, FinishTask, GoalFailed, GoalReached, SendGoal
from headless_mission import NAVIGATION_CONFIG, HeadlessMission
from headless_mission.navigation import NavigationHooks
from move_base_lite import Decision, Status, load_settings
from pick_objects import load_mission
from planar import OccupancyGrid, PlanarError, Pose2, Scan, save_map
from planar.config.parameters import settings_from_yaml
from planar.maps.map_score import MapScore
from planar_ros.node.entry import use_one_blas_thread
from sim_bridge import (
    Episode,
    EpisodeHooks,
    RobotProfile,
    Simulation,
    StepResult,
    load_world,
    robot_named,
)
from sim_bridge.world import World
from slam_lite.config import NodeSettings
from slam_lite.mapper import Mapper
from slam_lite.rendering import Extent, SessionRenderer

ROOT = Path(__file__).resolve().parents[2]
KINECT_CONFIG = ROOT / "src/move_base_lite/config/turtlebot_kinect.yaml"
SLAM_CONFIG = ROOT / "src/slam_lite/config/turtlebot.yaml"
LONGEST_SECONDS = 600.0
EXPLORE_PERIOD = 0.1


@dataclass(frozen=True)
class MappingResult:
    """One run: its result, the quality of the map, and the errors of the mapper. Metres, seconds."""

    seed: int
    success: bool
    reason: str
    simulated_seconds: float
    cpu_seconds: float
    recall: float
    precision: float
    doubled_walls: int
    way_home: float
    collisions: int
    mean_error: float
    max_error: float
    mission: Optional[bool] = None


class MappingRun(EpisodeHooks):
    """Explores one world with one seed, with a map every ``map_update_interval`` as in the node."""

    def __init__(self, world: World, robot: RobotProfile, seed: int):
        simulation = Simulation(world, robot, seed=seed)
        self._settings, _ = settings_from_yaml(NodeSettings, SLAM_CONFIG)
        self.mapper = Mapper(self._settings)
        self._renderer = SessionRenderer(self._settings.resolution, self._settings.occupied_threshold)
        field_of_view = robot.laser.beams * robot.laser.angle_increment
        self._explorer = Explorer(ExplorerSettings(field_of_view=field_of_view))
        settings = load_settings(NAVIGATION_CONFIG, *([KINECT_CONFIG] if field_of_view < math.pi else []))
        self._navigation = NavigationHooks(settings)
        self._episode = Episode(simulation, self._navigation.period, hooks=(self, self._navigation))
        self._map_stamp = -np.inf
        self._new_grid: Optional[OccupancyGrid] = None
        self._end: Optional[FinishTask] = None
        self.true_keyframes: List[np.ndarray] = []
        self.collisions = 0
        self.base_in_world = Pose2()
        self.now = 0.0

    def run(self) -> FinishTask:
        """Explore to the end and return the result."""
        try:
            while self._end is None:
                self._episode.advance()
                if self._end is None and self.now > LONGEST_SECONDS:
                    self._end = FinishTask(False, f"not done within {LONGEST_SECONDS:g} simulated seconds")
        finally:
            self._episode.simulation.close()
        return self._end

    def after_step(self, episode: Episode, step: StepResult) -> None:
        self.collisions += len(step.contacts)
        if step.scan is not None:
            self._new_grid = self._map(step, step.scan) or self._new_grid

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        """Advance the exploration by the outcome of the last tick; its hooks precede those of navigation."""
        self.now, self.base_in_world = step.stamp, step.base_in_world
        if not self.true_keyframes or self._navigation.base_in_map is None:
            return
        event, grid, self._new_grid = _event_of(self._navigation.result.decision), self._new_grid, None
        order = self._explorer.advance(self.now, grid, self._navigation.base_in_map, event)
        if isinstance(order, SendGoal):
            self._navigation.move_base.set_goal(order.pose)
        elif isinstance(order, FinishTask):
            self._end = order

    def _map(self, seen: StepResult, scan: Scan) -> Optional[OccupancyGrid]:
        update = self.mapper.insert(seen.odometry.base_in_odom, scan)
        if update is not None:
            self._navigation.poses.set_odom_in_map(update.odom_in_map)
            if update.is_keyframe:
                self.true_keyframes.append(seen.base_in_world.as_array())
        if scan.stamp - self._map_stamp < self._settings.map_update_interval:
            return None
        self._map_stamp = scan.stamp
        grid = self.grid(self._settings.extent)
        self._navigation.move_base.set_map(grid)
        return grid

    def grid(self, extent: Optional[Extent] = None) -> OccupancyGrid:
        """Render the present map; with an ``extent`` as the node publishes it."""
        self._renderer.update(self.mapper.evidence())
        return self._renderer.grid(extent)


def _event_of(decision: Decision):
    if decision.status is Status.SUCCEEDED:
        return GoalReached()
    return GoalFailed(decision.text) if decision.status is Status.ABORTED else None


def judge(run: MappingRun, end: FinishTask, score: MapScore, seed: int, cpu: float, mission) -> MappingResult:
    way_home = run.base_in_world.distance_to(Pose2())
    estimated = run.mapper.keyframe_poses
    errors = np.hypot(*(estimated[:, :2] - np.array(run.true_keyframes)[:, :2]).T)
    complaints = [
        (not end.success, end.reason),
        (way_home > ARRIVAL_TOLERANCE, f"{way_home:.2f} m from the start"),
        (score.recall < LEAST_RECALL, "recall"),
        (score.precision < LEAST_PRECISION, "precision"),
        (score.doubled_walls > 0, "doubled walls"),
        (run.collisions > 0, "collision"),
        (mission is False, "the mission on its map"),
    ]
    reasons = [text for is_wrong, text in complaints if is_wrong]
    return MappingResult(
        seed,
        not reasons,
        "; ".join(reasons) or end.reason,
        run.now,
        cpu,
        **asdict(score),
        way_home=way_home,
        collisions=run.collisions,
        mean_error=float(errors.mean()),
        max_error=float(errors.max()),
        mission=mission,
    )


def main() -> int:
    use_one_blas_thread()
    options = _options()
    robot = robot_named(options.robot)
    results = []
    try:
        world = load_world(options.world)
        for seed in options.seeds:
            results.append(_one(options, world, robot, seed))
    except PlanarError as error:
        sys.exit(f"mapping.py: error: {error}")
    successes = sum(result.success for result in results)
    print(f"{successes} of {len(results)} succeeded")
    if options.json:
        options.json.write_text(json.dumps([asdict(result) for result in results], indent=2) + "\n")
    return 0 if successes == len(results) else 1


def _one(options, world: World, robot: RobotProfile, seed: int) -> MappingResult:
    start = time.process_time()
    run = MappingRun(world, robot, seed)
    end = run.run()
    cpu = time.process_time() - start
    grid = run.grid()
    score = score_against_world(grid, world, robot)
    if options.maps:
        options.maps.mkdir(parents=True, exist_ok=True)
        save_map(grid, options.maps / f"{seed}")
    drives_well = None
    if options.mission:
        mission = load_mission(options.mission)
        drives_well = HeadlessMission(world, robot, grid, mission, seed).run().verdict.success
    result = judge(run, end, score, seed, cpu, drives_well)
    print(
        f"seed {seed}: {'SUCCESS' if result.success else 'FAILURE'}: {result.reason}\n"
        f"  {result.simulated_seconds:.0f} s simulated, {cpu:.0f} s of CPU, recall {result.recall:.3f}, "
        f"precision {result.precision:.3f}, {result.doubled_walls} doubled walls, "
        f"back {result.way_home:.2f} m from the start, {result.collisions} collisions, "
        f"keyframes off by {result.mean_error:.3f} m (at most {result.max_error:.3f})",
        flush=True,
    )
    return result


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=seeds, default=range(10), help="such as 0-9 (default) or 7")
    parser.add_argument("--world", type=Path, default=ROOT / "map/home.world", help="default: the home")
    parser.add_argument("--robot", default="turtlebot_lidar", help="profile (default: turtlebot_lidar)")
    parser.add_argument("--maps", type=Path, metavar="FOLDER", help="write the maps there")
    parser.add_argument("--json", type=Path, help="write the figures here")
    parser.add_argument("--mission", type=Path, metavar="FILE", help="drive this on each map")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
