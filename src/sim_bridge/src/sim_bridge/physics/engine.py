"""Rigid bodies in PyBullet: what stands and moves in a world, and what touches what."""

import itertools
import math
from dataclasses import dataclass, field
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from scipy.spatial import ConvexHull

from sim_bridge.description.structure import RobotModel
from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import IDENTITY, cross, inverse, position, quaternion, transform_points
from sim_bridge.geometry.shapes import Box, Cylinder, Mesh, Plane, Shape, Sphere
from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.physics.multibody import Tree, grow
from sim_bridge.world import Body, Collision, Joint

# Bits of Bullet's collision groups: it puts what moves into 1 and what does not into 2.
WORLD_GROUPS = 1 | 2
ROBOT_GROUP = 4

SOLVER_ITERATIONS = 50
# Bullet's limits: shapes of one compound, and triangles of one mesh (of its 131072 vertices each has three).
COMPOUND_SIZE = 16
MESH_SIZE = 40000
# N m/rad or N/m of what holds a joint within its limits.
LIMIT_FORCE = 1e4
# How far down a floor is looked for, metres.
DEEPEST_FLOOR = 10.0


@dataclass(frozen=True, eq=False)
class Motion:
    """Where a frame is and how it moves: ``pose`` (4, 4), velocities ``linear`` and ``angular`` (3,).

    All in the world; the velocity is that of the frame's origin.
    """

    pose: np.ndarray
    linear: np.ndarray
    angular: np.ndarray


class Contact(NamedTuple):
    """Where a robot touches ``link``: z of the unit normal there, and how deep the two overlap, metres."""

    link: str
    point: Tuple[float, float, float]
    normal_z: float
    depth: float


@dataclass(frozen=True, eq=False)
class _Link:
    """A link in Bullet's numbers; ``centre`` (4, 4): of its mass and principal axes in its own frame."""

    number: int
    index: int
    centre: np.ndarray
    from_centre: np.ndarray = field(init=False)

    def __post_init__(self):
        object.__setattr__(self, "from_centre", inverse(self.centre))


@dataclass(frozen=True, eq=False)
class MassProperties:
    """``mass`` in kg, ``moments`` (3,) in kg m^2; ``centre``: (4, 4) of mass and principal axes in the link.

    Without weight a link is not drawn down.
    """

    mass: float
    centre: np.ndarray
    moments: np.ndarray
    has_weight: bool


class JointState(NamedTuple):
    """``position`` in rad or m, ``speed`` in rad/s or m/s."""

    position: float
    speed: float


@dataclass(frozen=True, eq=False)
class _Joint:
    """A joint that moves, in Bullet's numbers."""

    number: int
    index: int
    joint: Joint


class Engine:
    """A physics engine of its own; nothing is shared between two of them. ``rate``: steps per second.

    Links are known by their names, ``model::link``.
    """

    def __init__(self, rate: int, gravity: float):
        self._bullet = BulletClient()
        self._bullet.setPhysicsEngineParameter(
            numSolverIterations=SOLVER_ITERATIONS, deterministicOverlappingPairs=1
        )
        self.set_rate(rate)
        self._bullet.setGravity(0.0, 0.0, -gravity)
        self._links: Dict[str, _Link] = {}
        self._joints: Dict[str, _Joint] = {}
        self._names: Dict[Tuple[int, int], str] = {}
        self._attachments: Dict[Tuple[str, str], int] = {}
        # Links that are not drawn down, and their masses.
        self._weightless: Dict[str, float] = {}
        self._gravity = gravity

    def close(self) -> None:
        self._bullet.disconnect()

    def step(self) -> None:
        for name, mass in self._weightless.items():
            self.push(name, (0.0, 0.0, mass * self._gravity), (0.0, 0.0, 0.0))
        self._bullet.stepSimulation()

    def set_rate(self, rate: int) -> None:
        """``rate``: steps per second."""
        self._bullet.setPhysicsEngineParameter(fixedTimeStep=1.0 / rate)

    def set_gravity(self, gravity: float) -> None:
        """``gravity``: downwards, m/s^2."""
        self._gravity = gravity
        self._bullet.setGravity(0.0, 0.0, -gravity)

    def motion_of(self, name: str) -> Motion:
        link = self._links[name]
        if link.index < 0:
            centre = _pose(*self._bullet.getBasePositionAndOrientation(link.number))
            linear, angular = map(np.array, self._bullet.getBaseVelocity(link.number))
        else:
            state = self._bullet.getLinkState(
                link.number, link.index, computeLinkVelocity=1, computeForwardKinematics=1
            )
            centre, (linear, angular) = _pose(*state[:2]), map(np.array, state[6:8])
        pose = centre @ link.from_centre
        return Motion(pose, linear - cross(angular, centre[:3, 3] - pose[:3, 3]), angular)

    def pose_of(self, name: str) -> np.ndarray:
        """Where a link is, (4, 4) in the world."""
        link = self._links[name]
        return self._centre_of(link) @ link.from_centre

    def set_motion(self, name: str, motion: Motion) -> None:
        """Puts a link to another place, with all that hangs together with it, and sets its velocity."""
        link = self._links[name]
        centre = motion.pose @ link.centre
        if link.index >= 0:
            root = _pose(*self._bullet.getBasePositionAndOrientation(link.number))
            centre = centre @ inverse(self._centre_of(link)) @ root
        self._bullet.resetBasePositionAndOrientation(link.number, position(centre), quaternion(centre))
        linear = motion.linear + cross(motion.angular, centre[:3, 3] - motion.pose[:3, 3])
        self._bullet.resetBaseVelocity(link.number, linear.tolist(), motion.angular.tolist())

    def push(self, name: str, force: Sequence[float], torque: Sequence[float]) -> None:
        """Force, N, at the centre of a link's mass, and torque, N m, in the world; for the next step only."""
        link = self._links[name]
        pose, *_ = self._bullet.getBasePositionAndOrientation(link.number)
        if link.index >= 0:
            pose, *_ = self._bullet.getLinkState(link.number, link.index)
        self._bullet.applyExternalForce(link.number, link.index, force, pose, pybullet.WORLD_FRAME)
        self._bullet.applyExternalTorque(link.number, link.index, torque, pybullet.WORLD_FRAME)

    def add(self, bodies: Sequence[Body], joints: Sequence[Joint] = ()) -> None:
        """Puts bodies into the world. Raises WorldError if one of that name is there already."""
        for body in bodies:
            if body.name in self._links:
                raise WorldError(f"{body.name} is in the world already")
        for tree in grow(bodies, joints):
            self._add_tree(tree)

    def remove(self, name: str) -> None:
        """Takes away a link and all that hangs together with it."""
        number = self._links[name].number
        for pair in list(self._attachments):
            if number in (self._links[link].number for link in pair):
                self.detach(*pair)
        self._bullet.removeBody(number)
        self._links = {key: link for key, link in self._links.items() if link.number != number}
        self._joints = {key: joint for key, joint in self._joints.items() if joint.number != number}
        self._names = {key: known for key, known in self._names.items() if key[0] != number}
        self._weightless = {key: mass for key, mass in self._weightless.items() if key in self._links}

    def has_link(self, name: str) -> bool:
        return name in self._links

    def attach(self, first: str, second: str) -> None:
        """Holds two links together as they are now until they are detached; meanwhile they never collide."""
        if (first, second) in self._attachments:
            self.detach(first, second)
        one, other = self._links[first], self._links[second]
        other_in_one = inverse(self._centre_of(one)) @ self._centre_of(other)
        self._attachments[first, second] = self._bullet.createConstraint(
            one.number,
            one.index,
            other.number,
            other.index,
            pybullet.JOINT_FIXED,
            [0.0, 0.0, 0.0],
            position(other_in_one),
            [0.0, 0.0, 0.0],
            quaternion(other_in_one),
        )
        self._let_collide(one, other, False)

    def is_attached(self, first: str, second: str) -> bool:
        return (first, second) in self._attachments

    def detach_all(self) -> None:
        for pair in list(self._attachments):
            self.detach(*pair)

    def detach(self, first: str, second: str) -> None:
        """Lets go what was attached in this order."""
        self._bullet.removeConstraint(self._attachments.pop((first, second)))
        self._let_collide(self._links[first], self._links[second], True)

    def joint_state(self, name: str) -> JointState:
        joint = self._joints[name]
        return JointState(*self._bullet.getJointState(joint.number, joint.index)[:2])

    def set_joint(self, name: str, state: JointState) -> None:
        """Puts a joint to a position, with all that hangs on it."""
        joint = self._joints[name]
        self._bullet.resetJointState(joint.number, joint.index, state.position, state.speed)

    def push_joint(self, name: str, effort: float) -> None:
        """``effort``: N m or N, at most what the joint bears; for the next step only."""
        joint = self._joints[name]
        limit = joint.joint.effort
        self._bullet.setJointMotorControl2(
            joint.number, joint.index, pybullet.TORQUE_CONTROL, force=max(-limit, min(effort, limit))
        )

    def mass_properties(self, name: str) -> MassProperties:
        link = self._links[name]
        mass, _, moments, *_ = self._bullet.getDynamicsInfo(link.number, link.index)
        return MassProperties(mass, link.centre, np.array(moments), name not in self._weightless)

    def set_mass(self, name: str, mass: float, moments: Sequence[float], has_weight: bool) -> None:
        """``mass`` in kg, ``moments`` (3,) about the principal axes, kg m^2."""
        link = self._links[name]
        self._bullet.changeDynamics(link.number, link.index, mass=mass, localInertiaDiagonal=list(moments))
        self._weightless.pop(name, None)
        if not has_weight:
            self._weightless[name] = mass

    def set_joint_limits(self, name: str, lower: float, upper: float, damping: float) -> None:
        """Limits in rad or m, ``damping`` in N m s/rad or N s/m."""
        joint = self._joints[name]
        self._limit(joint.number, joint.index, lower, upper)
        self._bullet.changeDynamics(joint.number, joint.index, jointDamping=damping)

    def add_robot(self, name: str, model: RobotModel, base_in_space: np.ndarray) -> None:
        """Puts a robot into the world; its links are ``name::link``. The mass of a wheel is at its hub."""
        base, wheels = model.base, list(model.wheels.values())
        centre = np.eye(4)
        centre[:3, 3] = base.centre_of_mass
        base_shape, *more = self._compounds(base.collisions, moves=True, origin=centre) or [-1]
        wheel_shapes = [(self._compounds(wheel.part.collisions, moves=True) or [-1])[0] for wheel in wheels]
        placed = base_in_space @ centre
        number = self._bullet.createMultiBody(
            baseMass=base.mass,
            baseCollisionShapeIndex=base_shape,
            basePosition=position(placed),
            baseOrientation=quaternion(placed),
            **_links(
                wheel_shapes + more,
                [inverse(centre) @ wheel.origin_in_base for wheel in wheels] + [np.eye(4)] * len(more),
                masses=[wheel.part.mass for wheel in wheels],
                axes=[wheel.axis.tolist() for wheel in wheels],
            ),
        )
        parts = [(base, 0.0), *((wheel.part, 1.0) for wheel in wheels), *((base, 0.0) for _ in more)]
        # The base slides: its casters roll any way, and its sides must not climb walls.
        for index, (part, friction) in enumerate(parts, -1):
            inertia = {} if index >= len(wheels) else {"localInertiaDiagonal": part.inertia.tolist()}
            self._bullet.changeDynamics(number, index, lateralFriction=friction, **inertia, **_UNDAMPED)
            self._bullet.setCollisionFilterGroupMask(number, index, ROBOT_GROUP, WORLD_GROUPS | ROBOT_GROUP)
            self._names[number, index] = f"{name}::{part.name}"
        self._links[f"{name}::{base.name}"] = _Link(number, -1, centre)
        for index, wheel in enumerate(wheels):
            self._links[f"{name}::{wheel.part.name}"] = _Link(number, index, IDENTITY)

    def drive_wheels(self, base: str, speeds: Sequence[float], efforts: Sequence[float]) -> None:
        """The motors of a robot's wheels aim at ``speeds``, rad/s, with at most ``efforts``, N m."""
        self._bullet.setJointMotorControlArray(
            self._links[base].number,
            list(range(len(efforts))),
            pybullet.VELOCITY_CONTROL,
            targetVelocities=speeds,
            forces=efforts,
        )

    def wheels(self, base: str, count: int) -> Tuple[Tuple[float, ...], Tuple[float, ...]]:
        """Angles, rad, and speeds, rad/s, of a robot's wheels."""
        states = self._bullet.getJointStates(self._links[base].number, list(range(count)))
        return tuple(state[0] for state in states), tuple(state[1] for state in states)

    def contacts(self, base: str) -> Iterator[Contact]:
        """What a robot touches, or nearly does (negative depth)."""
        for _, _, other, _, index, _, point, (_, _, normal_z), distance, *_ in self._bullet.getContactPoints(
            bodyA=self._links[base].number
        ):
            yield Contact(self._names[other, index], point, normal_z, -distance)

    def find_contacts(self) -> None:
        """Looks for contacts without a step."""
        self._bullet.performCollisionDetection()

    def floor_below(self, x: float, y: float, z: float) -> Optional[float]:
        """The height of the first of the world's bodies below a point, None if there is none."""
        (floor,) = self.floors_below([(x, y, z)])
        return floor if floor > -math.inf else None

    def floors_below(self, points: Sequence[Sequence[float]]) -> List[float]:
        """The heights of what is below points in space, -inf where there is nothing."""
        ends = [(x, y, z - DEEPEST_FLOOR) for x, y, z in points]
        hits = self._bullet.rayTestBatch(points, ends, collisionFilterMask=WORLD_GROUPS)
        return [point[2] if number >= 0 else -math.inf for number, _, _, point, _ in hits]

    def _centre_of(self, link: _Link) -> np.ndarray:
        """Where the centre of a link's mass is, with its principal axes, (4, 4) in the world."""
        if link.index < 0:
            return _pose(*self._bullet.getBasePositionAndOrientation(link.number))
        return _pose(*self._bullet.getLinkState(link.number, link.index, computeForwardKinematics=1)[:2])

    def _let_collide(self, one: _Link, other: _Link, may_collide: bool) -> None:
        """All parts of the one with all parts of the other."""
        parts = [[index for number, index in self._names if number == link.number] for link in (one, other)]
        for first, second in itertools.product(*parts):
            self._bullet.setCollisionFilterPair(one.number, other.number, first, second, int(may_collide))

    def _add_tree(self, tree: Tree) -> None:
        """Each body is a link on its parent's; the shapes that do not fit into one are fixed links on it."""
        root = tree.bodies[0]
        links: List[Dict[str, Any]] = []
        indices = [-1]
        root_shapes = self._compounds(root.collisions, root.mass is not None, root.inertia.pose_in_body) or [
            -1
        ]
        for body, joint, parent, frame in list(zip(tree.bodies, tree.joints, tree.parents, tree.frames))[1:]:
            assert joint is not None
            to_joint = inverse(frame)
            shapes = self._compounds(body.collisions, True, frame) or [-1]
            above = tree.bodies[parent]
            above_frame = root.inertia.pose_in_body if parent == 0 else tree.frames[parent]
            in_above = inverse(above.pose_in_world @ above_frame) @ body.pose_in_world @ frame
            links.append(
                _link(
                    shapes[0],
                    in_above @ inverse(_moved(joint, joint.start)),
                    indices[parent] + 1,
                    body.mass or 0.0,
                    to_joint @ body.inertia.pose_in_body,
                    joint,
                )
            )
            indices.append(len(links) - 1)
            links += [_link(shape, IDENTITY, indices[-1] + 1) for shape in shapes[1:]]
        links += [_link(shape, IDENTITY, 0) for shape in root_shapes[1:]]
        placed = root.pose_in_world @ root.inertia.pose_in_body
        number = self._bullet.createMultiBody(
            baseMass=root.mass or 0.0,
            baseCollisionShapeIndex=root_shapes[0],
            basePosition=position(placed),
            baseOrientation=quaternion(placed),
            **{key: [link[key] for link in links] for key in (links[0] if links else {})},
        )
        self._name_tree(tree, number, indices, links)

    def _name_tree(self, tree: Tree, number: int, indices: List[int], links: List[Dict[str, Any]]) -> None:
        """Tells Bullet what createMultiBody cannot take, and remembers which number is whose."""
        owner = dict(zip(indices, tree.bodies))
        for index, link in enumerate(links):
            owner.setdefault(index, owner[link["linkParentIndices"] - 1])
        for index, body in owner.items():
            self._names[number, index] = body.name
            self._bullet.changeDynamics(
                number,
                index,
                lateralFriction=body.surface.friction,
                restitution=body.surface.restitution,
                linearDamping=body.damping[0],
                angularDamping=body.damping[1],
                jointDamping=0.0,
            )
        for index, body, joint in zip(indices, tree.bodies, tree.joints):
            self._links[body.name] = _Link(number, index, body.inertia.pose_in_body)
            if body.inertia.moments is not None and body.mass is not None:
                self._bullet.changeDynamics(number, index, localInertiaDiagonal=body.inertia.moments.tolist())
            if not body.has_weight and body.mass is not None:
                self._weightless[body.name] = body.mass
            if joint is not None and joint.kind != "fixed":
                self._joints[joint.name] = _Joint(number, index, joint)
                self._loosen(number, index, joint)

    def _loosen(self, number: int, index: int, joint: Joint) -> None:
        """Bullet brakes every joint with a motor; here it only has the joint's own friction."""
        self._bullet.setJointMotorControl2(number, index, pybullet.VELOCITY_CONTROL, force=joint.friction)
        self._bullet.changeDynamics(number, index, jointDamping=joint.damping)
        self._limit(number, index, joint.lower, joint.upper)
        self._bullet.resetJointState(number, index, joint.start)

    def _limit(self, number: int, index: int, lower: float, upper: float) -> None:
        if upper - lower < np.inf:
            self._bullet.changeDynamics(
                number, index, jointLowerLimit=lower, jointUpperLimit=upper, jointLimitForce=LIMIT_FORCE
            )

    def _compounds(self, collisions: Sequence[Collision], moves: bool, origin=np.eye(4)) -> List[int]:
        """Bullet's numbers of shapes that together are the collisions seen from ``origin``, (4, 4)."""
        to_origin = inverse(origin)
        placed = [(part.shape, to_origin @ part.pose_in_body) for part in collisions]
        meshes = [(shape, pose) for shape, pose in placed if isinstance(shape, Mesh)]
        solids = [(shape, pose) for shape, pose in placed if not isinstance(shape, Mesh)]
        groups = [solids[at : at + COMPOUND_SIZE] for at in range(0, len(solids), COMPOUND_SIZE)]
        return [self._solid(group) for group in groups] + [
            number for mesh in meshes for number in self._mesh(*mesh, moves)
        ]

    def _solid(self, group: Sequence[Tuple[Shape, np.ndarray]]) -> int:
        if len(group) == 1:
            ((shape, pose),) = group
            return self._bullet.createCollisionShape(
                **_arguments(shape),
                collisionFramePosition=position(pose),
                collisionFrameOrientation=quaternion(pose),
            )
        parts = [{**_UNUSED_ARGUMENTS, **_arguments(shape)} for shape, _ in group]
        return self._bullet.createCollisionShapeArray(
            shapeTypes=[part["shapeType"] for part in parts],
            radii=[part["radius"] for part in parts],
            halfExtents=[part["halfExtents"] for part in parts],
            lengths=[part["height"] for part in parts],
            planeNormals=[part["planeNormal"] for part in parts],
            collisionFramePositions=[position(pose) for _, pose in group],
            collisionFrameOrientations=[quaternion(pose) for _, pose in group],
        )

    def _mesh(self, mesh: Mesh, pose: np.ndarray, moves: bool) -> List[int]:
        """A mesh as it is, in pieces, if it stands still; its convex hull if it moves."""
        vertices = transform_points(pose, mesh.vertices)
        if moves:
            hull = vertices[ConvexHull(vertices, qhull_options="QJ").vertices]
            return [self._bullet.createCollisionShape(pybullet.GEOM_MESH, vertices=hull.tolist())]
        pieces = []
        for at in range(0, len(mesh.triangles), MESH_SIZE):
            used, indices = np.unique(mesh.triangles[at : at + MESH_SIZE], return_inverse=True)
            pieces.append(
                self._bullet.createCollisionShape(
                    pybullet.GEOM_MESH,
                    vertices=vertices[used].tolist(),
                    indices=indices.ravel().tolist(),
                    flags=pybullet.GEOM_FORCE_CONCAVE_TRIMESH,
                )
            )
        return pieces


_UNDAMPED: Dict[str, float] = {"linearDamping": 0.0, "angularDamping": 0.0, "jointDamping": 0.0}
_UNUSED_ARGUMENTS: Dict[str, Any] = {
    "radius": 1.0,
    "halfExtents": [1.0, 1.0, 1.0],
    "height": 1.0,
    "planeNormal": [0.0, 0.0, 1.0],
}


def _pose(point: Sequence[float], orientation: Sequence[float]) -> np.ndarray:
    (x, y, z), r = point, pybullet.getMatrixFromQuaternion(orientation)
    return np.array((r[:3] + (x,), r[3:6] + (y,), r[6:] + (z,), (0.0, 0.0, 0.0, 1.0)))


def _arguments(shape: Shape) -> Dict[str, Any]:
    if isinstance(shape, Box):
        return {"shapeType": pybullet.GEOM_BOX, "halfExtents": [length / 2.0 for length in shape.size]}
    if isinstance(shape, Cylinder):
        return {"shapeType": pybullet.GEOM_CYLINDER, "radius": shape.radius, "height": shape.length}
    if isinstance(shape, Sphere):
        return {"shapeType": pybullet.GEOM_SPHERE, "radius": shape.radius}
    if isinstance(shape, Plane):
        return {"shapeType": pybullet.GEOM_PLANE, "planeNormal": list(shape.normal)}
    raise TypeError(f"not a primitive shape: {shape}")


def _links(
    shapes: Sequence[int],
    poses: Sequence[np.ndarray],
    masses: Sequence[float] = (),
    axes: Sequence[Sequence[float]] = (),
) -> Dict[str, Any]:
    """Arguments of createMultiBody for links on the base: the first turn about ``axes``, others are fixed."""
    count, fixed = len(shapes), len(shapes) - len(axes)
    return {
        "linkMasses": [*masses, *[0.0] * fixed],
        "linkCollisionShapeIndices": list(shapes),
        "linkVisualShapeIndices": [-1] * count,
        "linkPositions": [position(pose) for pose in poses],
        "linkOrientations": [quaternion(pose) for pose in poses],
        "linkInertialFramePositions": [[0.0, 0.0, 0.0]] * count,
        "linkInertialFrameOrientations": [[0.0, 0.0, 0.0, 1.0]] * count,
        "linkParentIndices": [0] * count,
        "linkJointTypes": [pybullet.JOINT_REVOLUTE] * len(axes) + [pybullet.JOINT_FIXED] * fixed,
        "linkJointAxis": [*axes, *[[0.0, 0.0, 1.0]] * fixed],
    }


def _moved(joint: Joint, by: float) -> np.ndarray:
    """The pose (4, 4) of a joint's frame moved ``by`` rad or m along its axis, seen from where it was."""
    pose = np.eye(4)
    if joint.kind == "prismatic":
        pose[:3, 3] = by * joint.axis
    elif joint.kind == "revolute":
        turn = pybullet.getQuaternionFromAxisAngle(joint.axis.tolist(), by)
        pose[:3, :3] = np.reshape(pybullet.getMatrixFromQuaternion(turn), (3, 3))
    return pose


def _link(
    shape: int,
    pose: np.ndarray,
    parent: int,
    mass: float = 0.0,
    centre: np.ndarray = IDENTITY,
    joint: Optional[Joint] = None,
) -> Dict[str, Any]:
    """createMultiBody's arguments for one link; ``parent``: 0 for the base, else 1 + the index of a link."""
    kinds = {"revolute": pybullet.JOINT_REVOLUTE, "prismatic": pybullet.JOINT_PRISMATIC}
    return {
        "linkMasses": mass,
        "linkCollisionShapeIndices": shape,
        "linkVisualShapeIndices": -1,
        "linkPositions": position(pose),
        "linkOrientations": quaternion(pose),
        "linkInertialFramePositions": position(centre),
        "linkInertialFrameOrientations": quaternion(centre),
        "linkParentIndices": parent,
        "linkJointTypes": pybullet.JOINT_FIXED
        if joint is None
        else kinds.get(joint.kind, pybullet.JOINT_FIXED),
        "linkJointAxis": [0.0, 0.0, 1.0] if joint is None else joint.axis.tolist(),
    }
