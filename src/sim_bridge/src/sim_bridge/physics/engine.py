"""The physics engine: bodies of a world in PyBullet."""

import math
from collections import Counter
from dataclasses import dataclass
from typing import Dict, Iterable, List, Sequence, Tuple

import numpy as np

from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import IDENTITY, cross, inverse, position, quaternion
from sim_bridge.physics.attachments import Attachments
from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.physics.collision_queries import CollisionQueries
from sim_bridge.physics.frames import centre_of_mass_of, is_any_moving, link_at, root_pose_of
from sim_bridge.physics.joints import Joints
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.physics.multibody import build_multibody, kinematic_trees
from sim_bridge.physics.registry import BodyRegistry
from sim_bridge.physics.surfaces import ContactSurfaces
from sim_bridge.world import Body, Joint

SOLVER_ITERATIONS = 50
# Change of the impulses in one iteration at which the solver stops; a wheel rolls within 0.1 mm/s of that.
SOLVER_RESIDUAL = 1e-6


@dataclass(frozen=True, eq=False)
class MassProperties:
    """Inertial properties of a link.

    Attributes:
        mass: Mass [kg].
        centre: Pose (4, 4) of the centre of mass and principal axes in the link frame.
        moments: Principal moments of inertia (3,) [kg m^2].
        has_gravity: Whether gravity acts on the link.
    """

    mass: float
    centre: np.ndarray
    moments: np.ndarray
    has_gravity: bool


@dataclass(eq=False)
class _PlanarBody:
    """Cached pose of a body that is only moved horizontally, by ``set_positions``.

    Attributes:
        body_id: Bullet's id of the body.
        x: Position of the centre of mass in the world frame [m], as are ``y`` and ``z``.
        orientation: Orientation of the centre of mass as a quaternion (x, y, z, w).
        link_above_origin: Pose (4, 4) of the link with its centre of mass at x = y = 0.
    """

    body_id: int
    x: float
    y: float
    z: float
    orientation: Tuple[float, ...]
    link_above_origin: np.ndarray


class Engine:
    """A physics engine with its own Bullet client; links are referred to by name, ``model::link``.

    Args:
        rate: Physics steps per second.
        gravity: Downward acceleration [m/s^2].

    Attributes:
        joints: Movable joints by name.
        attachments: Temporary fixed constraints.
        collision_queries: Contacts and floor heights.
    """

    def __init__(self, rate: int, gravity: float):
        self._bullet, self._registry = BulletClient(), BodyRegistry()
        # Friction is limited in two directions apart, as by default in Gazebo (ODE's pyramid model); Bullet's
        # cone costs half as much again.
        self._bullet.setPhysicsEngineParameter(
            numSolverIterations=SOLVER_ITERATIONS,
            solverResidualThreshold=SOLVER_RESIDUAL,
            deterministicOverlappingPairs=1,
            enableConeFriction=0,
        )
        self.set_gravity(gravity)
        # Masses of the links that gravity does not act on.
        self._weightless: Dict[str, float] = {}
        # Damping of the linear and angular velocity of the links that have any [1/s].
        self._damping: Dict[str, Tuple[float, float]] = {}
        # Mass properties that were set for static links, which have no mass in Bullet.
        self._static_masses: Dict[str, MassProperties] = {}
        # Bodies that set_positions has moved; removed when they are moved otherwise.
        self._planar_bodies: Dict[str, _PlanarBody] = {}
        self.joints = Joints(self._bullet, self._registry)
        self.attachments = Attachments(self._bullet, self._registry)
        self.collision_queries = CollisionQueries(self._bullet, self._registry)
        self._surfaces = ContactSurfaces(self._bullet, self._registry)
        self.set_rate(rate)

    def close(self) -> None:
        """Free the engine."""
        self._bullet.disconnect()

    def step(self, count: int = 1) -> None:
        """Simulate physics steps with constant motor targets.

        Args:
            count: Number of steps, a power of two.
        """
        if count != self._count:
            self._set_step_count(count)
        for name, mass in self._weightless.items():
            self.apply_wrench(name, (0.0, 0.0, mass * self._gravity), (0.0, 0.0, 0.0))
        if self._damping:
            _damp(self._bullet, self._registry, self._damping, count / self._rate)
        self._surfaces.update(count / self._rate)
        self.attachments.update()
        self._bullet.stepSimulation()

    def save_state(self) -> int:
        """Save poses and velocities of all bodies.

        Returns:
            An id for ``restore_state``.
        """
        return int(self._bullet.saveState())

    def restore_state(self, state_id: int) -> None:
        """Restore a saved state; no body may have been added or removed since."""
        self._bullet.restoreState(state_id)
        self._planar_bodies.clear()
        self._surfaces.reset()

    def set_rate(self, rate: int) -> None:
        """Set the number of physics steps per second."""
        self._rate = rate
        self._set_step_count(1)

    def _set_step_count(self, count: int) -> None:
        """Let each call of Bullet simulate ``count`` steps."""
        self._count = count
        substeps = count if count > 1 else 0
        self._bullet.setPhysicsEngineParameter(fixedTimeStep=count / self._rate, numSubSteps=substeps)

    def set_gravity(self, gravity: float) -> None:
        """Set the downward acceleration [m/s^2]."""
        self._gravity = gravity
        self._bullet.setGravity(0.0, 0.0, -gravity)

    @property
    def gravity(self) -> float:
        """Downward acceleration [m/s^2]."""
        return self._gravity

    def add(
        self, bodies: Sequence[Body], joints: Sequence[Joint] = (), placement: np.ndarray = IDENTITY
    ) -> None:
        """Add bodies and the joints between them.

        Args:
            bodies: The bodies; their poses are in the frame of ``placement``.
            joints: Joints between them, or to the world.
            placement: Pose (4, 4) in the world of the frame of the bodies' poses.

        Raises:
            WorldError: A name exists already or occurs twice, or a multibody would have too many parts. The
                engine is unchanged then.
        """
        for name, count in Counter(body.name for body in bodies).items():
            if self.has_link(name):
                raise WorldError(f"{name} is in the world already")
            if count > 1:
                raise WorldError(f"{name} would be in the world {count} times")
        built: List[int] = []
        for tree in kinematic_trees(bodies, joints):
            try:
                built.append(build_multibody(self._bullet, self._registry, tree, placement))
            except WorldError:
                for body_id in built:
                    self._remove_body(body_id)
                raise
            for body in tree.bodies:
                if not body.has_gravity and body.mass is not None:
                    self._weightless[body.name] = body.mass
            root = tree.bodies[0]
            if any(root.damping) and root.mass is not None:
                self._damping[root.name] = root.damping
        self._surfaces.reset()

    def remove(self, name: str) -> None:
        """Remove a link with its whole multibody."""
        body_id = self._registry.links[name].body_id
        self.attachments.detach_from(body_id)
        self._planar_bodies.pop(name, None)
        self._remove_body(body_id)

    def _remove_body(self, body_id: int) -> None:
        self._bullet.removeBody(body_id)
        self._registry.remove(body_id)
        self._surfaces.reset()
        self._weightless = {key: mass for key, mass in self._weightless.items() if self.has_link(key)}
        self._damping = {key: damping for key, damping in self._damping.items() if self.has_link(key)}
        self._static_masses = {key: mass for key, mass in self._static_masses.items() if self.has_link(key)}

    def has_link(self, name: str) -> bool:
        """Return whether there is a link of this name."""
        return name in self._registry.links

    def state_of(self, name: str) -> KinematicState:
        """Return the pose and velocity of a link's frame in the world."""
        link = self._registry.links[name]
        if link.link_index < 0:
            point, orientation = self._bullet.getBasePositionAndOrientation(link.body_id)
            linear, angular = self._bullet.getBaseVelocity(link.body_id)
        else:
            state = self._bullet.getLinkState(
                link.body_id, link.link_index, computeLinkVelocity=1, computeForwardKinematics=1
            )
            (point, orientation), (linear, angular) = state[:2], state[6:8]
        pose = link_at(link, point, orientation)
        arm = [there - here for there, here in zip(position(pose), point)]
        return KinematicState(pose, np.array(linear) + cross(angular, arm), np.array(angular))

    def is_moving(self, speed: float) -> bool:
        """Return whether physics moves anything along or about an axis faster than ``speed`` [m/s, rad/s]."""
        return is_any_moving(self._bullet, self._registry, speed)

    def pose_of(self, name: str) -> np.ndarray:
        """Return the pose (4, 4) of a link in the world frame."""
        planar = self._planar_bodies.get(name)
        if planar is None:
            link = self._registry.links[name]
            return centre_of_mass_of(self._bullet, link) @ link.from_centre
        pose = planar.link_above_origin.copy()
        pose[:2, 3] += planar.x, planar.y
        return pose

    def set_state(self, name: str, state: KinematicState) -> None:
        """Set the pose of a link, with its whole multibody, and the velocity unless it is static.

        Args:
            name: Name of the link.
            state: Pose and velocity of the link's frame in the world.
        """
        link = self._registry.links[name]
        self._planar_bodies.pop(name, None)
        centre = state.pose @ link.centre
        if link.link_index >= 0:
            centre = (
                centre @ inverse(centre_of_mass_of(self._bullet, link)) @ root_pose_of(self._bullet, link)
            )
        self._bullet.resetBasePositionAndOrientation(link.body_id, position(centre), quaternion(centre))
        if not self._registry.is_static(link.body_id):
            linear = state.linear + cross(state.angular, centre[:3, 3] - state.pose[:3, 3])
            self._bullet.resetBaseVelocity(link.body_id, linear.tolist(), state.angular.tolist())

    def set_velocity(self, name: str, linear: Sequence[float], angular: Sequence[float]) -> None:
        """Set the velocity of the root link of a body that physics moves.

        Args:
            name: Name of the link.
            linear: Velocity (3,) of the link frame's origin, in the world frame [m/s].
            angular: Angular velocity (3,), in the world frame [rad/s].
        """
        link = self._registry.links[name]
        centre = centre_of_mass_of(self._bullet, link)
        arm = centre[:3, 3] - (centre @ link.from_centre)[:3, 3]
        self._bullet.resetBaseVelocity(
            link.body_id, (np.array(linear) + cross(angular, arm)).tolist(), angular
        )

    def set_positions(self, positions: Iterable[Tuple[str, float, float]]) -> None:
        """Move single bodies in the plane; height and orientation stay (see KinematicBodies).

        Args:
            positions: Link name, x and y in the world frame [m] of each body.
        """
        set_pose = self._bullet.resetBasePositionAndOrientation
        for name, x, y in positions:
            body = self._planar_bodies.get(name)
            if body is None:
                self._set_first_position(name, x, y)
            else:
                set_pose(body.body_id, (x, y, body.z), body.orientation)
                body.x, body.y = x, y

    def _set_first_position(self, name: str, x: float, y: float) -> None:
        body_id = self._registry.links[name].body_id
        (_, _, z), orientation = self._bullet.getBasePositionAndOrientation(body_id)
        self._bullet.resetBasePositionAndOrientation(body_id, (x, y, z), orientation)
        (x, y, z_now), orientation_now = self._bullet.getBasePositionAndOrientation(body_id)
        if (z_now, orientation_now) == (z, orientation) and self._registry.is_static(body_id):
            link_above_origin = self.pose_of(name)
            link_above_origin[:2, 3] -= x, y
            self._planar_bodies[name] = _PlanarBody(body_id, x, y, z, orientation, link_above_origin)

    def apply_wrench(self, name: str, force: Sequence[float], torque: Sequence[float]) -> None:
        """Apply a wrench to a link for one physics step.

        Args:
            name: Name of the link.
            force: Force (3,) at the centre of mass, in the world frame [N].
            torque: Torque (3,), in the world frame [N m].
        """
        link = self._registry.links[name]
        pose, *_ = self._bullet.getBasePositionAndOrientation(link.body_id)
        if link.link_index >= 0:
            pose, *_ = self._bullet.getLinkState(link.body_id, link.link_index)
        self._bullet.applyExternalForce(link.body_id, link.link_index, force, pose, pybullet.WORLD_FRAME)
        self._bullet.applyExternalTorque(link.body_id, link.link_index, torque, pybullet.WORLD_FRAME)

    def mass_properties(self, name: str) -> MassProperties:
        """Return the mass properties of a link."""
        if name in self._static_masses:
            return self._static_masses[name]
        link = self._registry.links[name]
        mass, _, moments, *_ = self._bullet.getDynamicsInfo(link.body_id, link.link_index)
        return MassProperties(mass, link.centre, np.array(moments), name not in self._weightless)

    def set_mass(self, name: str, mass: float, moments: Sequence[float], has_gravity: bool) -> None:
        """Set the mass properties of a link.

        Args:
            name: Name of the link.
            mass: Mass [kg].
            moments: Principal moments of inertia (3,) [kg m^2].
            has_gravity: Whether gravity acts on the link.
        """
        link = self._registry.links[name]
        if self._registry.is_static(link.body_id):
            self._static_masses[name] = MassProperties(mass, link.centre, np.array(moments), has_gravity)
            return
        self._bullet.changeDynamics(
            link.body_id, link.link_index, mass=mass, localInertiaDiagonal=list(moments)
        )
        self._weightless.pop(name, None)
        if not has_gravity:
            self._weightless[name] = mass


def _damp(
    bullet: BulletClient, registry: BodyRegistry, damping: Dict[str, Tuple[float, float]], seconds: float
) -> None:
    """Reduce the velocities of root links by their damping of the linear and angular one [1/s]."""
    for name, rates in damping.items():
        body_id = registry.links[name].body_id
        keep_linear, keep_angular = (math.exp(-rate * seconds) for rate in rates)
        linear, angular = bullet.getBaseVelocity(body_id)
        bullet.resetBaseVelocity(
            body_id, [keep_linear * each for each in linear], [keep_angular * each for each in angular]
        )
