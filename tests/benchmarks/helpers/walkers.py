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
SLOWEST, FASTEST = 0.4, 0.8
# Metres between a person's and the robot's middle at which the person waits, and seconds before turning back.
COMFORT, PATIENCE = 0.55, 3.0
# m/s above which a robot in touch with a person counts as moving.
MOVING = 0.03


class Walker:
    """Walks along a path (N, 2) and back; waits when the robot is in the way, then turns back.

    A heedless one walks on.
    """

    def __init__(
        self, simulation: Simulation, name: str, path_xy: np.ndarray, speed: float, is_heedless: bool
    ):
        self.name = name
        self._comfort = -math.inf if is_heedless else COMFORT + RADIUS
        self._simulation, self._path_xy, self._speed = simulation, path_xy, speed
        steps = np.linalg.norm(np.diff(path_xy, axis=0), axis=1)
        self._travelled = np.concatenate(([0.0], np.cumsum(steps)))
        self._along, self._direction, self._waited = 0.0, 1.0, 0.0
        body = Collision(Cylinder(RADIUS, HEIGHT), np.eye(4))
        simulation.scene.add([Body(f"{name}::link", self._pose(), (body,))])

    def walk(self, robot: Pose2, seconds: float) -> None:
        """Moves on, unless the robot is in front."""
        ahead = self._along + self._direction * self._speed * seconds
        x, y = self._at(ahead)
        here = math.dist(self._at(self._along), (robot.x, robot.y))
        there = math.dist((x, y), (robot.x, robot.y))
        if there < min(self._comfort, here):
            self._waited += seconds
            if self._waited > PATIENCE:
                self._direction, self._waited = -self._direction, 0.0
            return
        self._waited = 0.0
        if not 0.0 < ahead < self._travelled[-1]:
            self._direction = -self._direction
        self._along = min(max(ahead, 0.0), float(self._travelled[-1]))
        still = np.zeros(3)
        self._simulation.scene.set_model_state(self.name, KinematicState(self._pose(), still, still))

    def _at(self, along: float):
        return tuple(np.interp(along, self._travelled, column) for column in self._path_xy.T)

    def _pose(self) -> np.ndarray:
        return from_pose2(Pose2(*self._at(self._along)), z=HEIGHT / 2.0)


def add_walkers(
    simulation: Simulation,
    count: int,
    settings: NavigatorSettings,
    grid: OccupancyGrid,
    places: List[Pose2],
    robot: Pose2,
    rng: np.random.Generator,
    are_heedless: bool = False,
) -> List[Walker]:
    """People between pairs of ``places``, two each, at speeds of people at home.

    Each starts at that of its places which is farther from the ``robot``, so that nobody stands in it.
    """
    navigator = Navigator(settings, grid)
    walkers = []
    for number in range(count):
        far, near = sorted(places[2 * number : 2 * number + 2], key=robot.distance_to, reverse=True)
        path_xy = navigator.make_plan(far, near)
        speed = rng.uniform(SLOWEST, FASTEST)
        walkers.append(Walker(simulation, f"walker_{number}", path_xy, speed, are_heedless))
    return walkers
