"""The bodies of a world and one robot in PyBullet."""

from typing import Any, Dict, List, Sequence, Set, Tuple

import numpy as np

from planar import Pose2, Twist2
from sim_bridge.bullet import BulletClient, pybullet
from sim_bridge.errors import WorldError
from sim_bridge.pose3 import from_pose2, position, quaternion, transform_points
from sim_bridge.robots import RobotProfile
from sim_bridge.shapes import Box, Cylinder, Mesh, Plane, Shape, Sphere
from sim_bridge.urdf_reader import Part, Wheel, read_robot
from sim_bridge.world import Body, Collision

# Bits of Bullet's collision groups: it puts what moves into 1 and what does not into 2.
WORLD_GROUPS = 1 | 2
ROBOT_GROUP = 4
EVERYTHING = -1

SOLVER_ITERATIONS = 50
# Bullet's limit for the shapes of one compound.
COMPOUND_SIZE = 16
# Metres that a robot at its start may reach into what it stands on.
START_DEPTH = 0.01
# Metres above and below the robot's start within which there must be a floor.
FLOOR_SEARCH = 0.1
# A contact whose normal rises more steeply than this carries the robot; it is no collision.
SUPPORTING_NORMAL_Z = 0.7


class Physics:
    """A physics engine of its own; nothing is shared between two of them.

    The robot starts with its base frame at ``base_in_world`` on the floor z = 0; ``rate``: steps per second.
    """

    def __init__(self, robot: RobotProfile, base_in_world: Pose2, rate: int, gravity: float):
        self._bullet = BulletClient()
        self._bullet.setPhysicsEngineParameter(
            fixedTimeStep=1.0 / rate, numSolverIterations=SOLVER_ITERATIONS, deterministicOverlappingPairs=1
        )
        self._bullet.setGravity(0.0, 0.0, -gravity)
        self._names: Dict[int, str] = {}
        model = read_robot(robot.description())
        wheels = [model.wheels[name] for name in (robot.drive.left_joint, robot.drive.right_joint)]
        self._efforts = [wheel.effort for wheel in wheels]
        self._centre_in_base = model.base.centre_of_mass
        self._wheels = list(range(len(wheels)))
        self._robot = self._add_robot(model.base, wheels, from_pose2(base_in_world))

    def close(self) -> None:
        self._bullet.disconnect()

    def step(self, wheel_speeds: Sequence[float]) -> None:
        """Moves on by one step; the motors aim at ``wheel_speeds`` of the left and right wheel, rad/s."""
        self._bullet.setJointMotorControlArray(
            self._robot,
            self._wheels,
            pybullet.VELOCITY_CONTROL,
            targetVelocities=wheel_speeds,
            forces=self._efforts,
        )
        self._bullet.stepSimulation()

    def base_in_space(self) -> np.ndarray:
        """The robot's base frame in the world, (4, 4)."""
        pose = _pose(*self._bullet.getBasePositionAndOrientation(self._robot))
        pose[:3, 3] -= pose[:3, :3] @ self._centre_in_base
        return pose

    def twist_in_base(self, base_in_space: np.ndarray) -> Twist2:
        """Velocity of the base frame's origin along its own x axis, and turn rate."""
        (vx, vy, _), (_, _, omega) = self._bullet.getBaseVelocity(self._robot)
        arm_x, arm_y, _ = base_in_space[:3, :3] @ self._centre_in_base
        forward_x, forward_y = base_in_space[:2, 0]
        return Twist2(float((vx + omega * arm_y) * forward_x + (vy - omega * arm_x) * forward_y), omega)

    def wheels(self) -> Tuple[Tuple[float, float], Tuple[float, float]]:
        """Angles, rad, and speeds, rad/s, of the left and right wheel."""
        (left, left_speed, *_), (right, right_speed, *_) = self._bullet.getJointStates(
            self._robot, self._wheels
        )
        return (left, right), (left_speed, right_speed)

    def touched(self) -> Set[str]:
        """Names of the bodies the robot bumps into; what it stands on is not among them."""
        return {
            self._names[body]
            for _, _, body, _, _, _, _, (_, _, normal_z), distance, *_ in self._contacts()
            if distance <= 0.0 and abs(normal_z) < SUPPORTING_NORMAL_Z
        }

    def check_start(self) -> None:
        """Raises WorldError if the robot has no floor to stand on or stands in something."""
        self._bullet.performCollisionDetection()
        x, y, z = position(self.base_in_space())
        ((_, _, share, _, _),) = self._bullet.rayTestBatch(
            [[x, y, z + FLOOR_SEARCH]], [[x, y, z - FLOOR_SEARCH]], collisionFilterMask=WORLD_GROUPS
        )
        deep = {self._names[contact[2]] for contact in self._contacts() if contact[8] < -START_DEPTH}
        if deep or self.touched():
            names = ", ".join(sorted(deep | self.touched()))
            raise WorldError(f"the robot would start at ({x:g}, {y:g}), inside {names}")
        if share >= 1.0:
            raise WorldError(f"the robot would start at ({x:g}, {y:g}), where there is no floor")

    def _contacts(self):
        """Bullet's contacts of the robot: [2] the other body, [7] the normal on it, [8] the distance."""
        return self._bullet.getContactPoints(bodyA=self._robot)

    def pose_of(self, name: str) -> np.ndarray:
        """Where a body is now, (4, 4) in the world."""
        number = next(number for number, known in self._names.items() if known == name)
        return _pose(*self._bullet.getBasePositionAndOrientation(number))

    def add(self, body: Body) -> None:
        """Puts a body into the world. Raises WorldError if one of its name is there already."""
        if body.name in self._names.values():
            raise WorldError(f"{body.name} is in the world already")
        first, *others = self._compounds(body.collisions, moves=body.mass is not None)
        number = self._bullet.createMultiBody(
            baseMass=body.mass or 0.0,
            baseCollisionShapeIndex=first,
            basePosition=position(body.pose_in_world),
            baseOrientation=quaternion(body.pose_in_world),
            **_links(others, [np.eye(4)] * len(others)),
        )
        for link in range(-1, len(others)):
            self._bullet.changeDynamics(number, link, lateralFriction=body.friction)
        self._names[number] = body.name

    def _add_robot(self, base: Part, wheels: List[Wheel], base_in_space: np.ndarray) -> int:
        centre = np.eye(4)
        centre[:3, 3] = base.centre_of_mass
        (base_shape,) = self._compounds(base.collisions, moves=True, origin=centre)
        wheel_shapes = [self._compounds(wheel.part.collisions, moves=True)[0] for wheel in wheels]
        base_in_space = base_in_space @ centre
        robot = self._bullet.createMultiBody(
            baseMass=base.mass,
            baseCollisionShapeIndex=base_shape,
            basePosition=position(base_in_space),
            baseOrientation=quaternion(base_in_space),
            **_links(
                wheel_shapes,
                [np.linalg.inv(centre) @ wheel.origin_in_base for wheel in wheels],
                masses=[wheel.part.mass for wheel in wheels],
                axes=[wheel.axis.tolist() for wheel in wheels],
            ),
        )
        # The base slides: its casters roll any way, and its sides must not climb walls.
        self._bullet.changeDynamics(
            robot,
            -1,
            lateralFriction=0.0,
            linearDamping=0.0,
            angularDamping=0.0,
            localInertiaDiagonal=base.inertia.tolist(),
        )
        for link, wheel in enumerate(wheels):
            self._bullet.changeDynamics(
                robot,
                link,
                lateralFriction=1.0,
                linearDamping=0.0,
                angularDamping=0.0,
                jointDamping=0.0,
                localInertiaDiagonal=wheel.part.inertia.tolist(),
            )
        for link in range(-1, len(wheels)):
            self._bullet.setCollisionFilterGroupMask(robot, link, ROBOT_GROUP, WORLD_GROUPS)
        return robot

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
