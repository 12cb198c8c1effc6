"""A wheeled robot in the physics engine."""

import math
from typing import List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from planar import Twist2
from sim_bridge.physics.collision_queries import Contact
from sim_bridge.physics.engine import Engine
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.physics.standstill import Standstill
from sim_bridge.world import Body, Joint

# Penetration of the floor that is accepted at the start [m].
MAX_START_DEPTH = 0.01
# Distance added to the penetration depth when a robot is moved out of an obstacle [m].
CLEARANCE = 0.001
# A contact with a normal steeper than this supports the robot and is no collision.
SUPPORTING_NORMAL_Z = 0.7


class Overlap(NamedTuple):
    """Obstacles that a robot overlaps.

    Attributes:
        links: Names of the overlapped links.
        x: Displacement along the world's x axis that resolves the deepest overlap [m].
        y: Displacement along the world's y axis [m].
    """

    links: Tuple[str, ...]
    x: float
    y: float


class Vehicle:
    """A base with driven wheels, or an omnidirectional one without.

    Args:
        engine: The physics engine.
        name: Name of the robot.
        bodies: The base, then the wheels; poses are in the base frame.
        joints: The wheels' joints, those on the left first; none for an omnidirectional base.
        left_count: Number of wheels on the left.
        torque: Largest torque of each motor [N m].
        base_in_space: Start pose (4, 4) of the base in the world frame.

    Attributes:
        links: Names of the links, ``model::link``, the base first.
        base: Name of the base link.
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
        self._engine = engine
        self._speeds: Optional[Tuple[float, float]] = None
        self.is_omnidirectional = not joints
        if joints:
            self._motors = engine.joints.motors([joint.name for joint in joints])
            self._standstill = Standstill(engine, self.base, self._motors)

    def drive(self, left_speed: float, right_speed: float, seconds: float) -> None:
        """Set the target speeds of the wheels.

        Args:
            left_speed: Of the wheels on the left [rad/s].
            right_speed: Of the wheels on the right [rad/s].
            seconds: Time since the last call [s].
        """
        if self._speeds != (left_speed, right_speed):
            self._speeds = (left_speed, right_speed)
            speeds = [left_speed] * self._left_count + [right_speed] * self._right_count
            self._motors.set_velocities(speeds, self._efforts)
            self._standstill.release()
        elif left_speed == right_speed == 0.0:
            self._standstill.update(seconds)

    def move(self, velocity: Twist2, seconds: float) -> None:
        """Set the velocity of an omnidirectional base, as gazebo_ros_planar_move does.

        Args:
            velocity: Velocity in the base frame.
            seconds: Time until the next call [s].
        """
        heading = self.state().pose2.yaw + 0.5 * velocity.omega * seconds  # half way of the turn that follows
        cosine, sine = math.cos(heading), math.sin(heading)
        x_speed = velocity.v * cosine - velocity.lateral * sine
        y_speed = velocity.v * sine + velocity.lateral * cosine
        self._engine.set_velocity(self.base, (x_speed, y_speed, 0.0), (0.0, 0.0, velocity.omega))

    def invalidate_speeds(self) -> None:
        """Send the target speeds again at the next ``drive``, even if they are unchanged."""
        self._speeds = None

    def state(self) -> KinematicState:
        """Return the pose and velocity of the base frame in the world."""
        return self._engine.state_of(self.base)

    @property
    def is_held(self) -> bool:
        """Whether static friction holds it, because it has stood for a while; never if omnidirectional."""
        return not self.is_omnidirectional and self._standstill.is_held

    def wheels(self) -> Tuple[Tuple[float, ...], Tuple[float, ...]]:
        """Return the angles [rad] and speeds [rad/s] of the wheels, those on the left first."""
        return ((), ()) if self.is_omnidirectional else self._motors.states()

    def body(self) -> Body:
        """Return the base at its present pose, as the sensors of other robots see it."""
        return Body(self.base, self.state().pose, self._collisions, mass=1.0)

    def collision_contacts(self) -> List[Contact]:
        """Return the contacts of the base with obstacles, without those that support it."""
        contacts = self._engine.collision_queries.contacts(self.base, max_normal_z=SUPPORTING_NORMAL_Z)
        return [contact for contact in contacts if contact.depth >= 0.0]

    def floors_below(self, points: Sequence[Sequence[float]]) -> List[float]:
        """Return the height of the floor below each of several points.

        Args:
            points: Points (N, 3) in the world [m].

        Returns:
            The heights (N,) [m]; -inf where there is no floor.
        """
        return self._engine.collision_queries.floors_below(points)

    def cast_rays(
        self, origin: np.ndarray, directions: np.ndarray, max_range: float
    ) -> Tuple[np.ndarray, List[str]]:
        """Cast rays at all but this robot (``CollisionQueries.cast_rays``)."""
        return self._engine.collision_queries.cast_rays(origin, directions, max_range, self.base)

    @property
    def gravity(self) -> float:
        """Downward acceleration [m/s^2]."""
        return self._engine.gravity

    def overlap(self) -> Optional[Overlap]:
        """Return the obstacles that the robot overlaps; None if there are none."""
        collision_queries = self._engine.collision_queries
        collision_queries.detect_collisions()
        sunk = [
            contact for contact in collision_queries.contacts(self.base) if contact.depth > MAX_START_DEPTH
        ]
        overlapping = sunk + self.collision_contacts()
        if not overlapping:
            return None
        deepest = max(overlapping, key=lambda contact: contact.depth)
        distance = deepest.depth + CLEARANCE
        links = tuple(sorted({contact.link for contact in overlapping}))
        return Overlap(links, deepest.normal[0] * distance, deepest.normal[1] * distance)


def twist_in_base(state: KinematicState, is_omnidirectional: bool = False) -> Twist2:
    """Return the velocity of a base along its x axis [m/s] and its turn rate [rad/s].

    Args:
        state: Pose and velocity of the base frame in the world.
        is_omnidirectional: Whether to return the velocity along the y axis, too.
    """
    linear, pose = state.linear, state.pose
    forward = linear.item(0) * pose.item(0, 0) + linear.item(1) * pose.item(1, 0)
    if not is_omnidirectional:
        return Twist2(forward, state.angular.item(2))
    lateral = linear.item(0) * pose.item(0, 1) + linear.item(1) * pose.item(1, 1)
    return Twist2(forward, state.angular.item(2), lateral)
