"""A wheeled robot among the bodies of an engine."""

from typing import List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from planar import Twist2
from sim_bridge.physics.collision_queries import Contact
from sim_bridge.physics.engine import Engine
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.world import Body, Joint

# Metres that a robot at its start may reach into what it stands on.
START_DEPTH = 0.01
# Metres by which a robot is moved out of what it stands in, a little at a time, before it stands free.
CLEARANCE = 0.001
# A contact whose normal rises more steeply than this carries the robot; it is no collision.
SUPPORTING_NORMAL_Z = 0.7


class Overlap(NamedTuple):
    """What a robot stands in, and the shortest way out of the worst of it, metres."""

    links: Tuple[str, ...]
    x: float
    y: float


class Vehicle:
    """The robot ``name``: a base, the first of ``bodies``, and wheels on ``joints``, those on the left first.

    The base starts at ``base_in_space``, (4, 4), which the bodies' poses are seen from; ``left_count`` wheels
    are on the left; ``torque``, N m, is what each motor has.
    """

    def __init__(
        self,
        engine: Engine,
        name: str,
        bodies: Sequence[Body],
        joints: Sequence[Joint],
        left_count: int,
        torque: float,
        base_in_space: np.ndarray,
    ):
        engine.add(bodies, joints, base_in_space)
        self.name = name
        self.links = tuple(body.name for body in bodies)
        self.base = self.links[0]
        engine.collision_queries.set_robot_filter(self.base)
        self._collisions = bodies[0].collisions
        self._left_count, self._right_count = left_count, len(joints) - left_count
        self._efforts = [torque] * len(joints)
        self._motors = engine.joints.motors([joint.name for joint in joints])
        self._engine = engine
        self._speeds: Optional[Tuple[float, float]] = None

    def drive(self, left_speed: float, right_speed: float) -> None:
        """The motors aim at these speeds of the wheels on the left and the right, rad/s, until told anew."""
        if self._speeds != (left_speed, right_speed):
            self._speeds = (left_speed, right_speed)
            speeds = [left_speed] * self._left_count + [right_speed] * self._right_count
            self._motors.set_velocities(speeds, self._efforts)

    def invalidate_speeds(self) -> None:
        """The motors may have been set otherwise, or have to be as physics goes at another rate."""
        self._speeds = None

    def state(self) -> KinematicState:
        """Of the base frame."""
        return self._engine.state_of(self.base)

    def wheels(self) -> Tuple[Tuple[float, ...], Tuple[float, ...]]:
        """Angles, rad, and speeds, rad/s, of the wheels, those on the left first."""
        return self._motors.states()

    def body(self) -> Body:
        """The robot as others see it: its base, where it is now."""
        return Body(self.base, self.state().pose, self._collisions, mass=1.0)

    def collision_contacts(self) -> List[Contact]:
        """Where the robot touches things; what it stands on is not among them."""
        contacts = self._engine.collision_queries.contacts(self.base, steepest=SUPPORTING_NORMAL_Z)
        return [contact for contact in contacts if contact.depth >= 0.0]

    def floors_below(self, points: Sequence[Sequence[float]]) -> List[float]:
        """The heights of what is below points in space, -inf where there is nothing."""
        return self._engine.collision_queries.floors_below(points)

    @property
    def gravity(self) -> float:
        """Downwards, m/s^2."""
        return self._engine.gravity

    def overlap(self) -> Optional[Overlap]:
        """What the robot stands in, None if in nothing."""
        collision_queries = self._engine.collision_queries
        collision_queries.detect_collisions()
        sunk = [contact for contact in collision_queries.contacts(self.base) if contact.depth > START_DEPTH]
        met = sunk + self.collision_contacts()
        if not met:
            return None
        deepest = max(met, key=lambda contact: contact.depth)
        way = deepest.depth + CLEARANCE
        links = tuple(sorted({contact.link for contact in met}))
        return Overlap(links, deepest.normal[0] * way, deepest.normal[1] * way)


def twist_in_base(motion: KinematicState) -> Twist2:
    """Velocity of the base frame's origin along its own x axis, and turn rate."""
    linear, pose = motion.linear, motion.pose
    ahead = linear.item(0) * pose.item(0, 0) + linear.item(1) * pose.item(1, 0)
    return Twist2(ahead, motion.angular.item(2))
