"""All people of a scene, moved on together."""

import math
from typing import Iterable, Sequence

import numpy as np

from planar import Pose2
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.geometry.shapes import Cylinder
from sim_bridge.people.forces import advance, push
from sim_bridge.people.walkable_area import RESOLUTION, WalkableArea
from sim_bridge.people.walker import Walker
from sim_bridge.physics.kinematics import KinematicBodies
from sim_bridge.robot import Robot
from sim_bridge.world import Body, Collision, World

# Times a second that people are moved on.
WALK_RATE = 25
# Metres from a goal at which one has come; by which one has to come nearer to it, however one sways, to get
# on, and for how many seconds one puts up with getting on no more before going elsewhere.
ARRIVED, NEARER, PATIENCE = 0.35, 0.3, 4.0
# Metres: of a robot to people, who keep more off it than it is wide.
ROBOT_RADIUS = 0.25
NOBODY = np.empty((0, 5))


class Crowd:
    """Knows where its people are, how they move, and what they feel of each other, of walls and of robots.

    ``links``, ``bodies``: of each; ``rows`` (N, 5): x, y, velocity by x and y, m/s, radius. Raises WorldError
    for a goal that nobody can stand at.
    """

    def __init__(self, walkers: Sequence[Walker], world: World):
        self._walkers = tuple(walkers)
        self.links = tuple(walker.link for walker in walkers)
        self.bodies = tuple(body_of(walker) for walker in walkers)
        self.rows = NOBODY
        if not walkers:
            return
        self._ground = WalkableArea(world, Pose2(*walkers[0].goals_xy[0].tolist()))
        goals = [len(walker.goals_xy) for walker in walkers]
        self._first_goals = np.concatenate(([0], np.cumsum(goals)[:-1])).astype(int)
        self._goals_xy = np.vstack([walker.goals_xy for walker in walkers])
        self._ways = self._ground.distances_to(self._goals_xy)
        self._groups = np.array([walker.group for walker in walkers])
        self._begin()

    def _begin(self) -> None:
        """Everybody stands where they begin."""
        firsts = [(*walker.goals_xy[0], 0.0, 0.0, walker.radius) for walker in self._walkers]
        self.rows = np.array(firsts, dtype=float).reshape(-1, 5)
        self._turns = [0] * len(self._walkers)
        # Until when each rests; how near to the goal each has come, metres of way, and since when no nearer.
        self._rests = [walker.rest for walker in self._walkers]
        self._nearest = [math.inf] * len(self._walkers)
        self._stuck_since = [0.0] * len(self._walkers)

    def update(
        self, engine: KinematicBodies, step: int, rate: int, stamp: float, robots: Iterable[Robot]
    ) -> None:
        """Before the step of physics number ``step``, of ``rate`` a second, which begins at ``stamp``.

        At time 0 all begin anew.
        """
        every = max(rate // WALK_RATE, 1)
        if not self._walkers or step % every:
            return
        if stamp == 0.0:
            self._begin()
        self._choose(stamp)
        speeds = [0.0 if stamp < rests else walker.speed for walker, rests in zip(self._walkers, self._rests)]
        corner = np.concatenate((self._ground.origin_xy, np.zeros(3)))
        seen = self.rows - corner
        advance(
            seen,
            np.array(speeds),
            np.array([first + turn for first, turn in zip(self._first_goals, self._turns)]),
            self._groups,
            rows_of(robots) - corner,
            self._ground.walls,
            self._ways,
            RESOLUTION,
            every / rate,
        )
        self.rows = seen + corner
        places = [(link, x, y) for link, (x, y, *_) in zip(self.links, self.rows.tolist())]
        engine.set_positions(
            place for place in places if engine.has_link(place[0])
        )  # nobody has taken it away

    def _choose(self, stamp: float) -> None:
        """Who has come to a goal rests and then goes to the next; so does who cannot get on."""
        for number, walker in enumerate(self._walkers):
            x, y = self.rows[number, :2].tolist()
            goal = self._first_goals[number] + self._turns[number]
            goal_x, goal_y = self._goals_xy[goal].tolist()
            is_there = math.hypot(goal_x - x, goal_y - y) < ARRIVED
            left = self._ground.remaining_distance(self._ways[goal], x, y)
            if is_there or stamp < self._rests[number] or left < self._nearest[number] - NEARER:
                self._nearest[number], self._stuck_since[number] = left, stamp
            if stamp < self._rests[number] or len(walker.goals_xy) == 1:
                continue
            if is_there or stamp - self._stuck_since[number] > PATIENCE:
                self._turns[number] = (self._turns[number] + 1) % len(walker.goals_xy)
                self._nearest[number], self._stuck_since[number] = math.inf, stamp
                self._rests[number] = stamp + walker.rest if is_there else stamp


def rows_of(robots: Iterable[Robot]) -> np.ndarray:
    """Robots as people see them, (M, 5)."""
    motions = [robot.vehicle.state() for robot in robots]
    rows = [(*motion.pose[:2, 3], *motion.linear[:2], ROBOT_RADIUS) for motion in motions]
    return np.array(rows, dtype=float).reshape(-1, 5)


def social_work(robot: np.ndarray, people: np.ndarray) -> float:
    """Of the forces, m/s^2, between a robot, (5,), and people, (N, 5): on it, and by it on each of them."""
    on_robot = np.linalg.norm(push(robot, people).sum(axis=0))
    on_people = sum(float(np.linalg.norm(push(each, robot[None, :]))) for each in people)
    return float(on_robot) + on_people


def body_of(walker: Walker) -> Body:
    """A cylinder, which is all that a laser sees of a person in a skirt."""
    place = from_pose2(Pose2(*walker.goals_xy[0].tolist()), z=walker.height / 2.0)
    solid = (Collision(Cylinder(walker.radius, walker.height), np.eye(4)),)
    return Body(walker.link, place, solid, is_kinematic=True)
