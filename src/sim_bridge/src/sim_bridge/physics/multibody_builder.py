"""Bodies that hang together, robots or models, as one of Bullet's multibodies."""

from typing import Any, Dict, List, Optional, Tuple

import numpy as np

from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import IDENTITY, inverse, position, quaternion
from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.physics.colliders import make_colliders
from sim_bridge.physics.joints import limit_joint
from sim_bridge.physics.multibody import KinematicTree
from sim_bridge.physics.registry import BodyRegistry, BulletJoint, BulletLink
from sim_bridge.world import Body, Joint

# Of which one of Bullet's multibodies is made: its root and its links.
MOST_PARTS = 128
_KINDS = {"revolute": pybullet.JOINT_REVOLUTE, "prismatic": pybullet.JOINT_PRISMATIC}


def build_multibody(
    bullet: BulletClient, register: BodyRegistry, tree: KinematicTree, placement: np.ndarray
) -> int:
    """Puts a tree, whose poses are seen from ``placement`` (4, 4), into Bullet; returns its number.

    Each body is a link on its parent's; the shapes that do not fit into one are fixed links on it. Raises
    WorldError if these are more than Bullet takes.
    """
    root = tree.bodies[0]
    centre = root.inertia.pose_in_body
    root_shape, *more = make_colliders(bullet, root.collisions, root.mass is not None, centre)
    links, indices = _hanging_links(bullet, tree)
    links += [_link(shape, IDENTITY, 0) for shape in more]
    if len(links) >= MOST_PARTS:
        raise WorldError(f"{root.name}: {len(links) + 1} parts hang together, {MOST_PARTS} is the most")
    is_static = all(body.mass is None for body in tree.bodies)
    placed = placement @ root.pose_in_world @ centre
    number = bullet.createMultiBody(
        baseMass=root.mass or 0.0,
        baseCollisionShapeIndex=root_shape,
        basePosition=position(placed),
        baseOrientation=quaternion(placed),
        # What Bullet calls a rigid body costs next to nothing in each step; it cannot have links.
        useMaximalCoordinates=int(is_static and not links),
        **{key: [link[key] for link in links] for key in (links[0] if links else {})},
    )
    if not is_static:
        register.dynamic_bodies.add(number)
    for index, body in _owners(tree, indices, links).items():
        register.assign_link(number, index, body.name)
        _finish_part(bullet, number, index, body)
    for index, body, joint in zip(indices, tree.bodies, tree.joints):
        register.links[body.name] = BulletLink(number, index, body.inertia.pose_in_body)
        if body.inertia.moments is not None and body.mass is not None:
            bullet.changeDynamics(number, index, localInertiaDiagonal=body.inertia.moments.tolist())
        if joint is not None and joint.kind != "fixed":
            register.joints[joint.name] = BulletJoint(number, index, joint)
            _loosen(bullet, number, index, joint)
    return number


def _hanging_links(bullet: BulletClient, tree: KinematicTree) -> Tuple[List[Dict[str, Any]], List[int]]:
    """Links of all bodies but the root, and the index of each body, the root's first."""
    links: List[Dict[str, Any]] = []
    indices = [-1]
    for body, joint, parent, frame in list(zip(tree.bodies, tree.joints, tree.parents, tree.frames))[1:]:
        assert joint is not None, "only the root hangs on nothing"
        shape, *more = make_colliders(bullet, body.collisions, True, frame)
        above = tree.bodies[parent]
        above_frame = above.inertia.pose_in_body if parent == 0 else tree.frames[parent]
        in_above = inverse(above.pose_in_world @ above_frame) @ body.pose_in_world @ frame
        start = in_above @ inverse(_moved(joint, joint.start))
        centre = inverse(frame) @ body.inertia.pose_in_body
        links.append(_link(shape, start, indices[parent] + 1, body.mass or 0.0, centre, joint))
        indices.append(len(links) - 1)
        links += [_link(part, IDENTITY, indices[-1] + 1) for part in more]
    return links, indices


def _owners(tree: KinematicTree, indices: List[int], links: List[Dict[str, Any]]) -> Dict[int, Body]:
    """Whose each link is; those of the same body hang on its first."""
    owners = dict(zip(indices, tree.bodies))
    for index, link in enumerate(links):
        owners.setdefault(index, owners[link["linkParentIndices"] - 1])
    return owners


def _finish_part(bullet: BulletClient, number: int, index: int, body: Body) -> None:
    """Tells Bullet what createMultiBody cannot take."""
    bullet.changeDynamics(
        number,
        index,
        lateralFriction=body.surface.friction,
        restitution=body.surface.restitution,
        linearDamping=body.damping[0],
        angularDamping=body.damping[1],
        jointDamping=0.0,
    )


def _loosen(bullet: BulletClient, number: int, index: int, joint: Joint) -> None:
    """Bullet brakes every joint with a motor; here it only has the joint's own friction."""
    bullet.setJointMotorControl2(number, index, pybullet.VELOCITY_CONTROL, force=joint.friction)
    bullet.changeDynamics(number, index, jointDamping=joint.damping)
    limit_joint(bullet, number, index, joint.lower, joint.upper)
    bullet.resetJointState(number, index, joint.start)


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
    return {
        "linkMasses": mass,
        "linkCollisionShapeIndices": shape,
        "linkVisualShapeIndices": -1,
        "linkPositions": position(pose),
        "linkOrientations": quaternion(pose),
        "linkInertialFramePositions": position(centre),
        "linkInertialFrameOrientations": quaternion(centre),
        "linkParentIndices": parent,
        "linkJointTypes": _KINDS.get(joint.kind if joint else "fixed", pybullet.JOINT_FIXED),
        "linkJointAxis": [0.0, 0.0, 1.0] if joint is None else joint.axis.tolist(),
    }
