"""Rigid bodies in PyBullet: what stands and moves in a world, and what touches what."""

from dataclasses import dataclass
from typing import Any, Dict, Iterator, List, NamedTuple, Sequence, Tuple

import numpy as np

from sim_bridge.bullet import BulletClient, pybullet
from sim_bridge.errors import WorldError
from sim_bridge.pose3 import cross, position, quaternion, transform_points
from sim_bridge.shapes import Box, Cylinder, Mesh, Plane, Shape, Sphere
from sim_bridge.urdf_reader import RobotModel
from sim_bridge.world import Body, Collision

# Bits of Bullet's collision groups: it puts what moves into 1 and what does not into 2.
WORLD_GROUPS = 1 | 2
ROBOT_GROUP = 4

SOLVER_ITERATIONS = 50
# Bullet's limit for the shapes of one compound.
COMPOUND_SIZE = 16


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
    """A link in Bullet's numbers; ``centre`` (3,): of its mass in its own frame."""

    number: int
    index: int
    centre: np.ndarray


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
        self._names: Dict[Tuple[int, int], str] = {}

    def close(self) -> None:
        self._bullet.disconnect()

    def step(self) -> None:
        self._bullet.stepSimulation()

    def set_rate(self, rate: int) -> None:
        """``rate``: steps per second."""
        self._bullet.setPhysicsEngineParameter(fixedTimeStep=1.0 / rate)

    def set_gravity(self, gravity: float) -> None:
        """``gravity``: downwards, m/s^2."""
        self._bullet.setGravity(0.0, 0.0, -gravity)

    def motion_of(self, name: str) -> Motion:
        link = self._links[name]
        if link.index < 0:
            pose = _pose(*self._bullet.getBasePositionAndOrientation(link.number))
            linear, angular = map(np.array, self._bullet.getBaseVelocity(link.number))
        else:
            state = self._bullet.getLinkState(link.number, link.index, computeLinkVelocity=1)
            pose, (linear, angular) = _pose(*state[:2]), map(np.array, state[6:8])
        arm = pose[:3, :3] @ link.centre
        pose[:3, 3] -= arm
        return Motion(pose, linear - cross(angular, arm), angular)

    def pose_of(self, name: str) -> np.ndarray:
        """Where a link is, (4, 4) in the world."""
        link = self._links[name]
        if link.index >= 0:
            return self.motion_of(name).pose
        pose = _pose(*self._bullet.getBasePositionAndOrientation(link.number))
        pose[:3, 3] -= pose[:3, :3] @ link.centre
        return pose

    def set_motion(self, name: str, motion: Motion) -> None:
        """Puts the base link of something to another place, and sets its velocity."""
        link = self._links[name]
        arm = motion.pose[:3, :3] @ link.centre
        centred = motion.pose.copy()
        centred[:3, 3] += arm
        self._bullet.resetBasePositionAndOrientation(link.number, position(centred), quaternion(centred))
        linear = motion.linear + cross(motion.angular, arm)
        self._bullet.resetBaseVelocity(link.number, linear.tolist(), motion.angular.tolist())

    def push(self, name: str, force: Sequence[float], torque: Sequence[float]) -> None:
        """Force, N, at the centre of a link's mass, and torque, N m, in the world; for the next step only."""
        link = self._links[name]
        pose, *_ = self._bullet.getBasePositionAndOrientation(link.number)
        if link.index >= 0:
            pose, *_ = self._bullet.getLinkState(link.number, link.index)
        self._bullet.applyExternalForce(link.number, link.index, force, pose, pybullet.WORLD_FRAME)
        self._bullet.applyExternalTorque(link.number, link.index, torque, pybullet.WORLD_FRAME)

    def add(self, body: Body) -> None:
        """Puts a body into the world. Raises WorldError if one of its name is there already."""
        if body.name in self._links:
            raise WorldError(f"{body.name} is in the world already")
        first, *others = self._compounds(body.collisions, moves=body.mass is not None) or [-1]
        number = self._bullet.createMultiBody(
            baseMass=body.mass or 0.0,
            baseCollisionShapeIndex=first,
            basePosition=position(body.pose_in_world),
            baseOrientation=quaternion(body.pose_in_world),
            **_links(others, [np.eye(4)] * len(others)),
        )
        for index in range(-1, len(others)):
            self._bullet.changeDynamics(number, index, lateralFriction=body.friction, **_UNDAMPED)
            self._names[number, index] = body.name
        self._links[body.name] = _Link(number, -1, np.zeros(3))

    def remove(self, name: str) -> None:
        """Takes away a link and all that hangs on it."""
        number = self._links[name].number
        self._bullet.removeBody(number)
        self._links = {key: link for key, link in self._links.items() if link.number != number}
        self._names = {key: known for key, known in self._names.items() if key[0] != number}

    def add_robot(
        self, name: str, model: RobotModel, joints: Sequence[str], base_in_space: np.ndarray
    ) -> None:
        """Puts a robot into the world, its wheels those on ``joints``; its links are ``name::link``."""
        base, wheels = model.base, [model.wheels[joint] for joint in joints]
        centre = np.eye(4)
        centre[:3, 3] = base.centre_of_mass
        (base_shape,) = self._compounds(base.collisions, moves=True, origin=centre)
        wheel_shapes = [self._compounds(wheel.part.collisions, moves=True)[0] for wheel in wheels]
        placed = base_in_space @ centre
        number = self._bullet.createMultiBody(
            baseMass=base.mass,
            baseCollisionShapeIndex=base_shape,
            basePosition=position(placed),
            baseOrientation=quaternion(placed),
            **_links(
                wheel_shapes,
                [np.linalg.inv(centre) @ wheel.origin_in_base for wheel in wheels],
                masses=[wheel.part.mass for wheel in wheels],
                axes=[wheel.axis.tolist() for wheel in wheels],
            ),
        )
        # The base slides: its casters roll any way, and its sides must not climb walls.
        for index, (part, friction) in enumerate([(base, 0.0)] + [(wheel.part, 1.0) for wheel in wheels], -1):
            self._bullet.changeDynamics(
                number,
                index,
                lateralFriction=friction,
                localInertiaDiagonal=part.inertia.tolist(),
                **_UNDAMPED,
            )
            self._bullet.setCollisionFilterGroupMask(number, index, ROBOT_GROUP, WORLD_GROUPS | ROBOT_GROUP)
            self._names[number, index] = f"{name}::{part.name}"
            self._links[f"{name}::{part.name}"] = _Link(
                number, index, base.centre_of_mass if index < 0 else np.zeros(3)
            )

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

    def hit_share(self, start: Sequence[float], end: Sequence[float]) -> float:
        """How much of the way between two points is free of the world's bodies: 1 if all of it."""
        ((_, _, share, _, _),) = self._bullet.rayTestBatch([start], [end], collisionFilterMask=WORLD_GROUPS)
        return share

    def _compounds(self, collisions: Sequence[Collision], moves: bool, origin=np.eye(4)) -> List[int]:
        """Bullet's numbers of shapes that together are the collisions seen from ``origin``, (4, 4)."""
        to_origin = np.linalg.inv(origin)
        placed = [(part.shape, to_origin @ part.pose_in_body) for part in collisions]
        meshes = [(shape, pose) for shape, pose in placed if isinstance(shape, Mesh)]
        solids = [(shape, pose) for shape, pose in placed if not isinstance(shape, Mesh)]
        groups = [solids[at : at + COMPOUND_SIZE] for at in range(0, len(solids), COMPOUND_SIZE)]
        return [self._solid(group) for group in groups] + [self._mesh(*mesh, moves) for mesh in meshes]

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

    def _mesh(self, mesh: Mesh, pose: np.ndarray, moves: bool) -> int:
        """A mesh as it is if it stands still, its convex hull if it moves."""
        concave: Dict[str, Any] = (
            {}
            if moves
            else {
                "indices": mesh.triangles.ravel().tolist(),
                "flags": pybullet.GEOM_FORCE_CONCAVE_TRIMESH,
            }
        )
        return self._bullet.createCollisionShape(
            pybullet.GEOM_MESH, vertices=transform_points(pose, mesh.vertices).tolist(), **concave
        )


_UNDAMPED: Dict[str, float] = {"linearDamping": 0.0, "angularDamping": 0.0, "jointDamping": 0.0}
_UNUSED_ARGUMENTS: Dict[str, Any] = {
    "radius": 1.0,
    "halfExtents": [1.0, 1.0, 1.0],
    "height": 1.0,
    "planeNormal": [0.0, 0.0, 1.0],
}


def _pose(point: Sequence[float], orientation: Sequence[float]) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, :3] = np.reshape(pybullet.getMatrixFromQuaternion(orientation), (3, 3))
    pose[:3, 3] = point
    return pose


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


def _links(shapes: Sequence[int], poses: Sequence[np.ndarray], masses=None, axes=None) -> Dict[str, Any]:
    """Arguments of createMultiBody for links on the base: fixed, or turning about ``axes``."""
    count = len(shapes)
    return {
        "linkMasses": masses or [0.0] * count,
        "linkCollisionShapeIndices": list(shapes),
        "linkVisualShapeIndices": [-1] * count,
        "linkPositions": [position(pose) for pose in poses],
        "linkOrientations": [quaternion(pose) for pose in poses],
        "linkInertialFramePositions": [[0.0, 0.0, 0.0]] * count,
        "linkInertialFrameOrientations": [[0.0, 0.0, 0.0, 1.0]] * count,
        "linkParentIndices": [0] * count,
        "linkJointTypes": [pybullet.JOINT_REVOLUTE if axes else pybullet.JOINT_FIXED] * count,
        "linkJointAxis": axes or [[0.0, 0.0, 1.0]] * count,
    }
