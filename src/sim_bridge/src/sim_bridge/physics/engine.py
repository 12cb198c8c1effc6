"""Rigid bodies in PyBullet: what stands and moves in a world."""

from collections import Counter
from dataclasses import dataclass
from typing import Dict, Iterable, List, Sequence, Tuple

import numpy as np

from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import IDENTITY, cross, inverse, position, quaternion
from sim_bridge.physics.attachments import Attachments
from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.physics.collision_queries import CollisionQueries
from sim_bridge.physics.frames import centre_of_mass_of, link_at, root_pose_of
from sim_bridge.physics.joints import Joints
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.physics.multibody import kinematic_trees
from sim_bridge.physics.multibody_builder import build_multibody
from sim_bridge.physics.registry import BodyRegistry
from sim_bridge.world import Body, Joint

SOLVER_ITERATIONS = 50


@dataclass(frozen=True, eq=False)
class MassProperties:
    """``mass`` in kg, ``moments`` (3,) in kg m^2; ``centre``: (4, 4) of mass and principal axes in the link.

    Without weight a link is not drawn down.
    """

    mass: float
    centre: np.ndarray
    moments: np.ndarray
    has_gravity: bool


@dataclass(eq=False)
class _Upright:
    """Body ``number``, which is only ever shifted: ``x``, ``y``, ``z`` of its centre, how it is turned, as a
    quaternion, and its link's pose (4, 4) with the centre above the origin.
    """

    number: int
    x: float
    y: float
    z: float
    turn: Tuple[float, ...]
    link_above_origin: np.ndarray


class Engine:
    """A physics engine of its own; nothing is shared between two of them. ``rate``: steps per second.

    Links are known by their names, ``model::link``. ``joints``, ``attachments`` and ``touch`` are its parts.
    """

    def __init__(self, rate: int, gravity: float):
        self._bullet = BulletClient()
        self._register = BodyRegistry()
        self._bullet.setPhysicsEngineParameter(
            numSolverIterations=SOLVER_ITERATIONS, deterministicOverlappingPairs=1
        )
        self.set_gravity(gravity)
        # Links that are not drawn down, and their masses.
        self._weightless: Dict[str, float] = {}
        # What links that stand have been told to weigh: in Bullet they have no mass.
        self._static_masses: Dict[str, MassProperties] = {}
        # What is shifted, as long as nobody puts it elsewhere.
        self._upright: Dict[str, _Upright] = {}
        self.joints = Joints(self._bullet, self._register)
        self.attachments = Attachments(self._bullet, self._register)
        self.collision_queries = CollisionQueries(self._bullet, self._register)
        self.set_rate(rate)

    def close(self) -> None:
        self._bullet.disconnect()

    def step(self, count: int = 1) -> None:
        """``count``: so many steps at once, in all of which the motors aim at the same; a power of two."""
        if count != self._count:
            self._time_steps(count)
        for name, mass in self._weightless.items():
            self.push(name, (0.0, 0.0, mass * self._gravity), (0.0, 0.0, 0.0))
        self.attachments.update()
        self._bullet.stepSimulation()

    def save_state(self) -> int:
        """Keeps where everything is and how it moves; returns the number by which ``go_back`` finds it."""
        return int(self._bullet.saveState())

    def restore_state(self, state_id: int) -> None:
        """Everything is again as when it was kept; no body may have come or gone since."""
        self._bullet.restoreState(state_id)
        self._upright.clear()

    def set_rate(self, rate: int) -> None:
        """``rate``: steps per second."""
        self._rate = rate
        self._time_steps(1)

    def _time_steps(self, count: int) -> None:
        """Bullet is to make so many steps at a time."""
        self._count = count
        substeps = count if count > 1 else 0
        self._bullet.setPhysicsEngineParameter(fixedTimeStep=count / self._rate, numSubSteps=substeps)

    def set_gravity(self, gravity: float) -> None:
        """``gravity``: downwards, m/s^2."""
        self._gravity = gravity
        self._bullet.setGravity(0.0, 0.0, -gravity)

    @property
    def gravity(self) -> float:
        """Downwards, m/s^2."""
        return self._gravity

    def add(
        self, bodies: Sequence[Body], joints: Sequence[Joint] = (), placement: np.ndarray = IDENTITY
    ) -> None:
        """Puts bodies into the world, their poses seen from ``placement``, (4, 4).

        Raises WorldError, and is as it was then, if one of that name is there already, or comes twice, or if
        what hangs together has too many parts.
        """
        for name, count in Counter(body.name for body in bodies).items():
            if self.has_link(name):
                raise WorldError(f"{name} is in the world already")
            if count > 1:
                raise WorldError(f"{name} would be in the world {count} times")
        built: List[int] = []
        for tree in kinematic_trees(bodies, joints):
            try:
                built.append(build_multibody(self._bullet, self._register, tree, placement))
            except WorldError:
                for number in built:
                    self._remove_body(number)
                raise
            for body in tree.bodies:
                if not body.has_gravity and body.mass is not None:
                    self._weightless[body.name] = body.mass

    def remove(self, name: str) -> None:
        """Takes away a link and all that hangs together with it."""
        number = self._register.links[name].number
        self.attachments.detach_from(number)
        self._upright.pop(name, None)
        self._remove_body(number)

    def _remove_body(self, number: int) -> None:
        self._bullet.removeBody(number)
        self._register.remove(number)
        self._weightless = {key: mass for key, mass in self._weightless.items() if self.has_link(key)}
        self._static_masses = {key: told for key, told in self._static_masses.items() if self.has_link(key)}

    def has_link(self, name: str) -> bool:
        return name in self._register.links

    def state_of(self, name: str) -> KinematicState:
        link = self._register.links[name]
        if link.index < 0:
            point, turn = self._bullet.getBasePositionAndOrientation(link.number)
            linear, angular = self._bullet.getBaseVelocity(link.number)
        else:
            state = self._bullet.getLinkState(
                link.number, link.index, computeLinkVelocity=1, computeForwardKinematics=1
            )
            (point, turn), (linear, angular) = state[:2], state[6:8]
        pose = link_at(link, point, turn)
        arm = [there - here for there, here in zip(position(pose), point)]
        return KinematicState(pose, np.array(linear) + cross(angular, arm), np.array(angular))

    def pose_of(self, name: str) -> np.ndarray:
        """Where a link is, (4, 4) in the world."""
        upright = self._upright.get(name)
        if upright is None:
            link = self._register.links[name]
            return centre_of_mass_of(self._bullet, link) @ link.from_centre
        pose = upright.link_above_origin.copy()
        pose[0, 3] += upright.x
        pose[1, 3] += upright.y
        return pose

    def set_state(self, name: str, motion: KinematicState) -> None:
        """Puts a link to another place, with all that hangs together with it, and sets its velocity.

        What stands has none.
        """
        link = self._register.links[name]
        self._upright.pop(name, None)
        centre = motion.pose @ link.centre
        if link.index >= 0:
            centre = (
                centre @ inverse(centre_of_mass_of(self._bullet, link)) @ root_pose_of(self._bullet, link)
            )
        self._bullet.resetBasePositionAndOrientation(link.number, position(centre), quaternion(centre))
        if not self._register.is_static(link.number):
            linear = motion.linear + cross(motion.angular, centre[:3, 3] - motion.pose[:3, 3])
            self._bullet.resetBaseVelocity(link.number, linear.tolist(), motion.angular.tolist())

    def set_positions(self, places: Iterable[Tuple[str, float, float]]) -> None:
        """Puts bodies that stand alone, by name, x and y, elsewhere, as high and turned as they are."""
        put = self._bullet.resetBasePositionAndOrientation
        for name, x, y in places:
            body = self._upright.get(name)
            if body is None:
                self._set_first_position(name, x, y)
            else:
                put(body.number, (x, y, body.z), body.turn)
                body.x, body.y = x, y

    def _set_first_position(self, name: str, x: float, y: float) -> None:
        number = self._register.links[name].number
        (_, _, z), turn = self._bullet.getBasePositionAndOrientation(number)
        self._bullet.resetBasePositionAndOrientation(number, (x, y, z), turn)
        (x, y, z_now), turn_now = self._bullet.getBasePositionAndOrientation(number)
        is_rounded = (z_now, turn_now) != (z, turn)
        if not is_rounded and self._register.is_static(number):
            link_above_origin = self.pose_of(name)
            link_above_origin[:2, 3] -= x, y
            self._upright[name] = _Upright(number, x, y, z, turn, link_above_origin)

    def push(self, name: str, force: Sequence[float], torque: Sequence[float]) -> None:
        """Force, N, at the centre of a link's mass, and torque, N m, in the world; for the next step only."""
        link = self._register.links[name]
        pose, *_ = self._bullet.getBasePositionAndOrientation(link.number)
        if link.index >= 0:
            pose, *_ = self._bullet.getLinkState(link.number, link.index)
        self._bullet.applyExternalForce(link.number, link.index, force, pose, pybullet.WORLD_FRAME)
        self._bullet.applyExternalTorque(link.number, link.index, torque, pybullet.WORLD_FRAME)

    def mass_properties(self, name: str) -> MassProperties:
        if name in self._static_masses:
            return self._static_masses[name]
        link = self._register.links[name]
        mass, _, moments, *_ = self._bullet.getDynamicsInfo(link.number, link.index)
        return MassProperties(mass, link.centre, np.array(moments), name not in self._weightless)

    def set_mass(self, name: str, mass: float, moments: Sequence[float], has_gravity: bool) -> None:
        """``mass`` in kg, ``moments`` (3,) about the principal axes, kg m^2."""
        link = self._register.links[name]
        if self._register.is_static(link.number):
            self._static_masses[name] = MassProperties(mass, link.centre, np.array(moments), has_gravity)
            return
        self._bullet.changeDynamics(link.number, link.index, mass=mass, localInertiaDiagonal=list(moments))
        self._weightless.pop(name, None)
        if not has_gravity:
            self._weightless[name] = mass
