"""Pedestrians in a simulated home: cylinders that walk back and forth along planned paths."""

import math
from typing import List

import numpy as np

from move_base_lite import Navigator, NavigatorSettings
from planar import OccupancyGrid, Pose2
from sim_bridge import Simulation
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.geometry.shapes import Cylinder
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.world import Body, Collision

RADIUS, HEIGHT = 0.2, 1.6
MIN_SPEED, MAX_SPEED = 0.4, 0.8
# Distance to the robot at which a pedestrian waits [m], and time before it turns back [s].
WAITING_DISTANCE, MAX_WAIT = 0.55, 3.0
# Speed above which a robot in contact with a pedestrian counts as moving [m/s].
MIN_MOVING_SPEED = 0.03


class Walker:
    """Walks along a path (N, 2) and back; waits when the robot is in the way, then turns back.

    A heedless pedestrian does not wait.
    """

    def __init__(
        self, simulation: Simulation, name: str, path_xy: np.ndarray, speed: float, is_heedless: bool
    ):
        self.name = name
        self._waiting_distance = -math.inf if is_heedless else WAITING_DISTANCE + RADIUS
        self._simulation, self._path_xy, self._speed = simulation, path_xy, speed
        steps = np.linalg.norm(np.diff(path_xy, axis=0), axis=1)
        self._travelled = np.concatenate(([0.0], np.cumsum(steps)))
        self._distance, self._direction, self._waited = 0.0, 1.0, 0.0
        body = Collision(Cylinder(RADIUS, HEIGHT), np.eye(4))
        simulation.scene.add([Body(f"{name}::link", self._pose(), (body,))])

    def walk(self, robot: Pose2, seconds: float) -> None:
        """Move on, unless the robot is in front."""
        ahead = self._distance + self._direction * self._speed * seconds
        x, y = self._at(ahead)
        here = math.dist(self._at(self._distance), (robot.x, robot.y))
        there = math.dist((x, y), (robot.x, robot.y))
        if there < min(self._waiting_distance, here):
            self._waited += seconds
            if self._waited > MAX_WAIT:
                self._direction, self._waited = -self._direction, 0.0
            return
        self._waited = 0.0
        if not 0.0 < ahead < self._travelled[-1]:
            self._direction = -self._direction
        self._distance = min(max(ahead, 0.0), float(self._travelled[-1]))
        still = np.zeros(3)
        self._simulation.scene.set_model_state(self.name, KinematicState(self._pose(), still, still))

    def _at(self, along: float):
        return tuple(np.interp(along, self._travelled, column) for column in self._path_xy.T)

    def _pose(self) -> np.ndarray:
        return from_pose2(Pose2(*self._at(self._distance)), z=HEIGHT / 2.0)


def add_walkers(
    simulation: Simulation,
    count: int,
    settings: NavigatorSettings,
    grid: OccupancyGrid,
    poses: List[Pose2],
    robot: Pose2,
    rng: np.random.Generator,
    are_heedless: bool = False,
) -> List[Walker]:
    """Add pedestrians that walk between pairs of ``poses``.

    Each starts at the pose of its pair that is farther from the ``robot``, to keep the robot's position free.
    """
    navigator = Navigator(settings, grid)
    walkers = []
    for number in range(count):
        far, near = sorted(poses[2 * number : 2 * number + 2], key=robot.distance_to, reverse=True)
        path_xy = navigator.make_plan(far, near)
        speed = rng.uniform(MIN_SPEED, MAX_SPEED)
        walkers.append(Walker(simulation, f"walker_{number}", path_xy, speed, are_heedless))
    return walkers
