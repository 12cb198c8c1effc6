"""Recorded drives of a simulated robot: what it measures, beside the truth."""

import heapq
import itertools
import math
from dataclasses import dataclass
from typing import List, Optional, Tuple

import numpy as np

from planar import FREE, OCCUPIED, OccupancyGrid, Pose2, Scan, Twist2, wrap
from planar.geometry.distance_field import distance_field
from sim_bridge import Episode, Simulation, SimulationSettings, robot_named
from sim_bridge.world import World

# How far the driver keeps from walls, and how near to a waypoint it takes the next, metres.
CLEARANCE, WAYPOINT_NEAR = 0.32, 0.25
SPEED, TURN_SPEED = 0.45, 1.2
CRAZY_TURN_SPEED = 2.5


@dataclass(frozen=True, eq=False)
class Observation:
    """One scan of a drive, with odometry and truth at its stamp.

    ``odometry_before``: stamps and poses of the odometry between the scan before and this one.
    """

    scan: Scan
    base_in_odom: Pose2
    base_in_map: Pose2
    odometry_before: Tuple[Tuple[float, Pose2], ...] = ()


class RandomDriver:
    """Drives, by the truth, to one random free place of a map after the other."""

    def __init__(self, grid: OccupancyGrid, rng: np.random.Generator):
        self._grid = grid
        clearance = distance_field(grid.cells == OCCUPIED, grid.resolution)
        self._open = (clearance > CLEARANCE) & (grid.cells == FREE)
        self._rng = rng
        self._waypoints: List[np.ndarray] = []

    def command(self, base_in_map: Pose2) -> Twist2:
        while (
            self._waypoints and math.dist(self._waypoints[0], (base_in_map.x, base_in_map.y)) < WAYPOINT_NEAR
        ):
            self._waypoints.pop(0)
        while not self._waypoints:
            self._waypoints = self._way_to_somewhere(base_in_map)
        x, y = self._waypoints[0]
        bearing = wrap(math.atan2(y - base_in_map.y, x - base_in_map.x) - base_in_map.yaw)
        speed = SPEED * max(0.0, math.cos(bearing)) ** 3 if abs(bearing) < 1.0 else 0.0
        return Twist2(speed, float(np.clip(2.5 * bearing, -TURN_SPEED, TURN_SPEED)))

    def _next_goal(self) -> np.ndarray:
        """The cell (row, col) to go to next."""
        goals = np.argwhere(self._open)
        return goals[self._rng.integers(len(goals))]

    def _way_to_somewhere(self, base_in_map: Pose2) -> List[np.ndarray]:
        start = tuple(self._grid.cells_of(np.array([[base_in_map.x, base_in_map.y]]))[0])
        cells = self._shortest_path(start, tuple(self._next_goal()))
        return list(self._grid.points_of(np.array(cells[4::4]))) if len(cells) > 8 else []

    def _shortest_path(self, start, goal) -> list:
        """Cells from start to goal (A*, eight neighbours); empty if there is no way."""
        came_from, cost, queue = {start: None}, {start: 0.0}, [(0.0, start)]
        while queue:
            _, cell = heapq.heappop(queue)
            if cell == goal:
                path = []
                while cell is not None:
                    path.append(cell)
                    cell = came_from[cell]
                return path[::-1]
            for d_row in (-1, 0, 1):
                for d_col in (-1, 0, 1):
                    there = (cell[0] + d_row, cell[1] + d_col)
                    if not (0 <= there[0] < self._grid.rows and 0 <= there[1] < self._grid.cols):
                        continue
                    if not self._open[there] and self._open[cell]:
                        continue
                    new_cost = cost[cell] + math.hypot(d_row, d_col)
                    if new_cost < cost.get(there, math.inf):
                        cost[there], came_from[there] = new_cost, cell
                        heapq.heappush(queue, (new_cost + math.dist(there, goal), there))
        return []


class Tour(RandomDriver):
    """Drives to given places (x, y), one after the other, again and again."""

    def __init__(self, grid: OccupancyGrid, *places_xy):
        super().__init__(grid, np.random.default_rng(0))
        self._goals = itertools.cycle(grid.cells_of(np.array(places_xy)))

    def _next_goal(self) -> np.ndarray:
        return next(self._goals)


class Crazy:
    """Another driver's way, but swinging from side to side, in jerks."""

    def __init__(self, driver: RandomDriver):
        self._driver = driver
        self._commands = 0

    def command(self, base_in_map: Pose2) -> Twist2:
        self._commands += 1
        sane = self._driver.command(base_in_map)
        swing = CRAZY_TURN_SPEED if self._commands % 10 < 5 else -CRAZY_TURN_SPEED
        return Twist2(sane.v if self._commands % 7 else 0.0, sane.omega + swing)


def drive(
    world: World,
    driver,
    seed: int,
    seconds: float,
    settings: SimulationSettings = SimulationSettings(),
    robot: str = "turtlebot_lidar",
    start: Optional[Pose2] = None,
) -> List[Observation]:
    """Drive for some simulated seconds by ``driver.command``; the map frame is the world frame."""
    simulation = Simulation(world, robot_named(robot), settings, seed, start or Pose2())
    episode = Episode(simulation, simulation.step_seconds)
    observations, before, command = [], [], None
    try:
        for _ in range(round(seconds / simulation.step_seconds)):
            seen = episode.step(command)
            base_in_odom, command = seen.odometry.base_in_odom, None
            if seen.scan is None:
                before.append((seen.stamp, base_in_odom))
            else:
                observations.append(Observation(seen.scan, base_in_odom, seen.base_in_world, tuple(before)))
                before, command = [], driver.command(seen.base_in_world)
    finally:
        simulation.close()
    return observations


def random_drive(world: World, grid: OccupancyGrid, seed: int, seconds: float, **others) -> List[Observation]:
    """Drives about, to random places; ``others`` as in ``drive``."""
    return drive(world, RandomDriver(grid, np.random.default_rng([seed, 99])), seed, seconds, **others)
