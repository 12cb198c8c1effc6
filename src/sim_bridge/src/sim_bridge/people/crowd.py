"""The pedestrians of a scene."""

import math
from typing import Iterable, Sequence

import numpy as np

from planar import Pose2
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.geometry.shapes import Cylinder
from sim_bridge.people.forces import advance, social_forces
from sim_bridge.people.walkable_area import RESOLUTION, WalkableArea
from sim_bridge.people.walker import Walker
from sim_bridge.physics.kinematics import KinematicBodies
from sim_bridge.robot import Robot
from sim_bridge.world import Body, Collision, World

# Rate at which pedestrians are moved [Hz].
WALK_RATE = 25
# Distance at which a goal is reached [m], decrease of the remaining path that counts as progress [m], and
# time without progress after which a pedestrian goes to the next goal [s].
GOAL_TOLERANCE, PROGRESS_DISTANCE, PATIENCE = 0.35, 0.3, 4.0
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
        self._area = WalkableArea(world, Pose2(*walkers[0].goals_xy[0].tolist()))
        goals = [len(walker.goals_xy) for walker in walkers]
        self._first_goals = np.concatenate(([0], np.cumsum(goals)[:-1])).astype(int)
        self._goals_xy = np.vstack([walker.goals_xy for walker in walkers])
        self._goal_distances = self._area.distances_to(self._goals_xy)
        self._groups = np.array([walker.group for walker in walkers])
        self._reset()

    def _reset(self) -> None:
        """Move all pedestrians to their first goals."""
        firsts = [(*walker.goals_xy[0], 0.0, 0.0, walker.radius) for walker in self._walkers]
        self.rows = np.array(firsts, dtype=float).reshape(-1, 5)
        self._goal_indices = [0] * len(self._walkers)
        # Time until which each rests, shortest remaining path so far [m], and time of the last progress.
        self._rest_until = [walker.rest for walker in self._walkers]
        self._shortest_remaining = [math.inf] * len(self._walkers)
        self._last_progress = [0.0] * len(self._walkers)

    def update(
        self, engine: KinematicBodies, step: int, rate: int, stamp: float, robots: Iterable[Robot]
    ) -> None:
        """Move the pedestrians, if due; at time 0 all return to their first goals.

        Args:
            engine: Holds their bodies.
            step: Number of the next physics step.
            rate: Physics steps per second.
            stamp: Simulated time [s].
            robots: The robots that they avoid.
        """
        every = max(rate // WALK_RATE, 1)
        if not self._walkers or step % every:
            return
        if stamp == 0.0:
            self._reset()
        self._select_goals(stamp)
        speeds = [
            0.0 if stamp < until else walker.speed for walker, until in zip(self._walkers, self._rest_until)
        ]
        corner = np.concatenate((self._area.origin_xy, np.zeros(3)))
        states = self.rows - corner
        advance(
            states,
            np.array(speeds),
            np.array([first + index for first, index in zip(self._first_goals, self._goal_indices)]),
            self._groups,
            rows_of(robots) - corner,
            self._area.walls,
            self._goal_distances,
            RESOLUTION,
            every / rate,
        )
        self.rows = states + corner
        positions = [(link, x, y) for link, (x, y, *_) in zip(self.links, self.rows.tolist())]
        # Bodies may have been deleted.
        engine.set_positions(each for each in positions if engine.has_link(each[0]))

    def _select_goals(self, stamp: float) -> None:
        """Choose the next goal of pedestrians that have rested at a goal or that make no progress."""
        for number, walker in enumerate(self._walkers):
            x, y = self.rows[number, :2].tolist()
            goal = self._first_goals[number] + self._goal_indices[number]
            goal_x, goal_y = self._goals_xy[goal].tolist()
            has_arrived = math.hypot(goal_x - x, goal_y - y) < GOAL_TOLERANCE
            remaining = self._area.remaining_distance(self._goal_distances[goal], x, y)
            if (
                has_arrived
                or stamp < self._rest_until[number]
                or remaining < self._shortest_remaining[number] - PROGRESS_DISTANCE
            ):
                self._shortest_remaining[number], self._last_progress[number] = remaining, stamp
            if stamp < self._rest_until[number] or len(walker.goals_xy) == 1:
                continue
            if has_arrived or stamp - self._last_progress[number] > PATIENCE:
                self._goal_indices[number] = (self._goal_indices[number] + 1) % len(walker.goals_xy)
                self._shortest_remaining[number], self._last_progress[number] = math.inf, stamp
                self._rest_until[number] = stamp + walker.rest if has_arrived else stamp


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
