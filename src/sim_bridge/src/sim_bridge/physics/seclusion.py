"""Whether a robot is so far from everything that it need not be asked what it touches."""

import math
from typing import Dict, Iterable, NamedTuple, Sequence

import numpy as np

from sim_bridge.geometry.pose3 import transform_points
from sim_bridge.geometry.shapes import outline
from sim_bridge.physics.bullet import BulletClient
from sim_bridge.physics.register import Register
from sim_bridge.world import Body

# Steps of physics that one look around is good for at most; that it must be good for to be worth its time;
# and if it was in vain, as beside a wall, after which the next one is.
MOST_STEPS, LEAST_STEPS, PAUSE = 20, 3, 10
# m/s^2 by which motors and gravity may change how any point of a robot moves: they are far weaker.
STRONGEST = 50.0
# Metres by which Bullet's shapes may be thicker than they are told.
SKIN = 0.01


class Extent(NamedTuple):
    """Metres that all of a robot stays within, whatever its wheels do: of the upright axis through the centre
    of its base's mass, and above or below that.
    """

    radius: float
    height: float


class Seclusion:
    """Of a robot that is the only thing that moves, but for interventions.

    Level planes are floors, which robots stand on: they do not count.
    """

    def __init__(self, bullet: BulletClient, register: Register):
        self._bullet = bullet
        self._register = register
        self.step_seconds = 0.0
        # By what number a robot has in Bullet.
        self.extents: Dict[int, Extent] = {}
        self._steps_left, self._is_given = 0, False
        self._interventions = 0

    def is_given(self, number: int) -> bool:
        """Whether the robot of that number cannot have touched anything in the step of physics that is over.

        To be asked after each step.
        """
        if self._steps_left == 0 or (self._is_given and self._interventions != self._register.interventions):
            self._interventions = self._register.interventions
            steps = self._look_around(number)
            self._is_given = steps >= LEAST_STEPS
            self._steps_left = steps if self._is_given else PAUSE
        self._steps_left -= 1
        return self._is_given

    def _look_around(self, number: int) -> int:
        """For how many steps, the one that is over among them, the robot cannot meet what is near."""
        if self._register.movers != {number}:
            return 0
        (x, y, z), (qx, qy, qz, qw) = self._bullet.getBasePositionAndOrientation(number)
        linear, (roll_rate, pitch_rate, _) = self._bullet.getBaseVelocity(number)
        radius, height = self.extents[number]
        size, seconds = radius + height, MOST_STEPS * self.step_seconds
        lean = height * 2.0 * math.hypot(qx * qz + qy * qw, qy * qz - qx * qw)
        fastest = math.hypot(*linear) + size * math.hypot(roll_rate, pitch_rate)
        way = lean + seconds * (fastest + 0.5 * STRONGEST * seconds)
        aside, up = radius + way, size + way
        low, high = (x - aside, y - aside, z - up), (x + aside, y + aside, z + up)
        near = {other for other, _ in self._bullet.getOverlappingObjects(low, high) or ()}
        gap = self._gap(number, near - {number} - self._register.level_planes, way) - lean
        if gap <= 0.0:
            return 0
        free = (math.sqrt(fastest * fastest + 2.0 * STRONGEST * gap) - fastest) / STRONGEST
        return min(int(free / self.step_seconds), MOST_STEPS)

    def _gap(self, number: int, others: Iterable[int], most: float) -> float:
        """Metres to the nearest of others, as far as it is nearer than ``most``."""
        gap = most
        for other in others:
            for point in self._bullet.getClosestPoints(number, other, gap + SKIN):
                gap = min(gap, point[8] - SKIN)
        return gap


def extent_of(bodies: Sequence[Body]) -> Extent:
    """Of a base, the first, and wheels, each of which turns about its own frame somehow, as they start."""
    base = bodies[0]
    centre = base.inertia.pose_in_body[:3, 3]
    xyz = _points_of(base) - centre
    radius, height = _farthest(xyz[:, :2]), _farthest(xyz[:, 2:])
    for wheel in bodies[1:]:
        hub = wheel.pose_in_world[:3, 3]
        size = _farthest(_points_of(wheel) - hub)
        radius = max(radius, math.hypot(*(hub - centre)[:2]) + size)
        height = max(height, abs(hub[2] - centre[2]) + size)
    return Extent(radius + SKIN, height + SKIN)


def _points_of(body: Body) -> np.ndarray:
    """The outermost points (N, 3) of a body where it is."""
    placed = [(body.pose_in_world @ part.pose_in_body, outline(part.shape)) for part in body.collisions]
    return np.vstack([np.empty((0, 3)), *(transform_points(pose, points) for pose, points in placed)])


def _farthest(points: np.ndarray) -> float:
    """Of points (N, D), metres from the origin; 0 of none."""
    return float(np.linalg.norm(points, axis=1).max(initial=0.0))
