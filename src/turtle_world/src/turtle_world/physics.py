"""Turtles as PyBullet bodies: round robots the size of a TurtleBot between four walls."""

import math
from typing import NamedTuple

from sim_bridge.physics.bullet import BulletClient, pybullet
from turtle_world.canvas import FLOOR_SIDE

# Period of turtlesim's timer [s].
PERIOD = 0.016
# Of a TurtleBot 2 [m, m, kg].
RADIUS, HEIGHT, MASS = 0.177, 0.42, 6.3
# Half the thickness of a wall [m]: no body passes through it in one period.
WALL = 1.0
TURTLE_GROUP, WALL_GROUP = 1, 2


class TurtlePose(NamedTuple):
    """Pose on the floor [m, m, rad]."""

    x: float
    y: float
    theta: float


class TurtlePhysics:
    """Bodies that slide over the floor at commanded velocities and collide with walls, not with each other.

    As in turtlesim, the centre of a body reaches the edge of the floor: the walls are set back by its radius.
    """

    def __init__(self):
        self._bullet = BulletClient()
        self._bullet.setPhysicsEngineParameter(fixedTimeStep=PERIOD, numSubSteps=1)
        self._shape = self._bullet.createCollisionShape(pybullet.GEOM_CYLINDER, radius=RADIUS, height=HEIGHT)
        middle, reach = 0.5 * FLOOR_SIDE, 0.5 * FLOOR_SIDE + RADIUS + WALL
        for along_x, along_y in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            half = [WALL if along_x else reach + WALL, WALL if along_y else reach + WALL, HEIGHT]
            box = self._bullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half)
            self._add(0.0, box, middle + along_x * reach, middle + along_y * reach, WALL_GROUP, TURTLE_GROUP)

    def add(self, pose: TurtlePose) -> int:
        """Add a body; returns its id in PyBullet."""
        number = self._add(MASS, self._shape, pose.x, pose.y, TURTLE_GROUP, WALL_GROUP)
        # It rotates about the vertical axis only, without damping.
        spin_inertia = 0.5 * MASS * RADIUS**2
        self._bullet.changeDynamics(
            number,
            -1,
            localInertiaDiagonal=(0.0, 0.0, spin_inertia),
            linearDamping=0.0,
            angularDamping=0.0,
            lateralFriction=0.0,
            restitution=0.0,
        )
        self.set_pose(number, pose)
        return number

    def remove(self, number: int) -> None:
        self._bullet.removeBody(number)

    def set_pose(self, number: int, pose: TurtlePose) -> None:
        """Set the pose of a body."""
        turned = (0.0, 0.0, math.sin(0.5 * pose.theta), math.cos(0.5 * pose.theta))
        self._bullet.resetBasePositionAndOrientation(number, (pose.x, pose.y, 0.0), turned)

    def set_velocity(self, number: int, velocity_x: float, velocity_y: float, turn: float) -> None:
        """Set the velocity of a body for the next step: m/s in the world frame, and rad/s."""
        self._bullet.resetBaseVelocity(number, (velocity_x, velocity_y, 0.0), (0.0, 0.0, turn))

    def step(self) -> None:
        """Advance by one period."""
        self._bullet.stepSimulation()

    def pose_of(self, number: int) -> TurtlePose:
        (x, y, _), (_, _, z, w) = self._bullet.getBasePositionAndOrientation(number)
        return TurtlePose(x, y, 2.0 * math.atan2(z, w))

    def _add(self, mass, shape, x, y, group, mask):
        number = self._bullet.createMultiBody(mass, shape, basePosition=(x, y, 0.0))
        self._bullet.setCollisionFilterGroupMask(number, -1, group, mask)
        self._bullet.changeDynamics(number, -1, lateralFriction=0.0)
        return number
