"""The pedestrians of a scene."""

import math
from typing import Iterable, Sequence

import numpy as np

from planar import Pose2
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.geometry.shapes import Cylinder
from sim_bridge.people.forces import social_forces
from sim_bridge.people.walkable_area import RESOLUTION, WalkableArea
from sim_bridge.people.walker import Walker
from sim_bridge.people.walking import walk
from sim_bridge.physics.kinematics import KinematicBodies, Steps
from sim_bridge.robot import Robot
from sim_bridge.world import Body, Collision, World

# Rate at which pedestrians are moved [Hz].
WALK_RATE = 25
# Radius of a robot for pedestrians, who keep a distance from it [m].
ROBOT_RADIUS = 0.25
NO_STATES = np.empty((0, 5))


class Crowd:
    """Moves the pedestrians of a scene by social forces.

    Args:
        walkers: The pedestrians.
        world: The world they walk in.

    Attributes:
        links: Names of their links, ``model::link``.
        bodies: Their bodies, for the physics engine.
        rows: Their states (N, 5): x, y [m], velocity along x and y [m/s], radius [m].

    Raises:
        WorldError: A goal is not in free space.
    """

    def __init__(self, walkers: Sequence[Walker], world: World):
        self._walkers = tuple(walkers)
        self.links = tuple(walker.link for walker in walkers)
        self.bodies = tuple(body_of(walker) for walker in walkers)
        self.rows = NO_STATES
        if not walkers:
            return
        area = WalkableArea(world, Pose2(*walkers[0].goals_xy[0].tolist()))
        goals_xy = np.vstack([walker.goals_xy for walker in walkers])
        counts = np.array([len(walker.goals_xy) for walker in walkers])
        plans = [(walker.speed, walker.rest) for walker in walkers]
        groups = np.array([walker.group for walker in walkers])
        firsts = np.cumsum(counts) - counts
        goal_distances = area.distances_to(goals_xy)
        # Arguments of ``walk`` that do not change.
        self._plans = np.array(plans), groups, firsts, counts, goals_xy, goal_distances
        self._walkable = area.walls, area.origin_xy, RESOLUTION
        self._reset()

    def _reset(self) -> None:
        """Move all pedestrians to their first goals."""
        firsts = [(*walker.goals_xy[0], 0.0, 0.0, walker.radius) for walker in self._walkers]
        self.rows = np.array(firsts, dtype=float).reshape(-1, 5)
        self._walked_xy, self._walked = self.rows[None, :, :2].copy(), range(0)
        self._goals = np.zeros(len(self._walkers), dtype=np.int64)
        self._progress = np.array([(walker.rest, math.inf, 0.0) for walker in self._walkers])

    def update(self, engine: KinematicBodies, steps: Steps, robots: Iterable[Robot]) -> None:
        """Move the pedestrians, if due; at time 0 all return to their first goals.

        Args:
            engine: Holds their bodies.
            steps: Physics steps before which they move, in which robots do not.
            robots: The robots that they avoid.
        """
        if not self._walkers or not (due := steps.due(WALK_RATE)):
            return
        stamps = steps.stamps(due)
        if stamps[0] == 0.0:
            self._reset()
        rows, seconds = self.rows.copy(), due.step / steps.rate
        state = rows, self._goals, self._progress, rows_of(robots)
        walked_xy = walk(*state, stamps, seconds, *self._plans, *self._walkable)
        self._walked_xy, self._walked = np.concatenate((self.rows[None, :, :2], walked_xy)), due
        self.rows = rows
        positions = [(link, x, y) for link, (x, y, *_) in zip(self.links, self.rows.tolist())]
        # Bodies may have been deleted.
        engine.set_positions(each for each in positions if engine.has_link(each[0]))

    def positions_before(self, steps: range) -> np.ndarray:
        """Return the positions (M, N, 2) of the pedestrians before physics steps (M,) [m].

        Args:
            steps: Numbers of steps in the interval of the last update.
        """
        if not self._walkers:
            return np.empty((len(steps), 0, 2))
        numbers = np.arange(steps.start, steps.stop, steps.step)
        return self._walked_xy[np.searchsorted(self._walked, numbers, side="right")]


def rows_of(robots: Iterable[Robot]) -> np.ndarray:
    """Return the states of robots.

    Returns:
        Rows (M, 5): x, y [m], velocity along x and y [m/s], radius [m], as ``Crowd.rows``.
    """
    states = [robot.vehicle.state() for robot in robots]
    rows = [(*state.pose[:2, 3], *state.linear[:2], ROBOT_RADIUS) for state in states]
    return np.array(rows, dtype=float).reshape(-1, 5)


def social_work(robot: np.ndarray, people: np.ndarray) -> float:
    """Return the social work of a robot among pedestrians.

    It is the sum of the magnitudes of the social forces on the robot, and by it on each pedestrian.

    Args:
        robot: State (5,) of the robot, as a row of ``Crowd.rows``.
        people: States (N, 5) of the pedestrians.

    Returns:
        The social work [m/s^2].
    """
    on_robot = np.linalg.norm(social_forces(robot, people).sum(axis=0))
    on_people = sum(float(np.linalg.norm(social_forces(each, robot[None, :]))) for each in people)
    return float(on_robot) + on_people


def body_of(walker: Walker) -> Body:
    """Return the body of a pedestrian: a cylinder."""
    pose = from_pose2(Pose2(*walker.goals_xy[0].tolist()), z=walker.height / 2.0)
    solid = (Collision(Cylinder(walker.radius, walker.height), np.eye(4)),)
    return Body(walker.link, pose, solid, is_kinematic=True)
