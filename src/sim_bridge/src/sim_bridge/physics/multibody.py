"""Groups bodies and joints into kinematic trees, and makes Bullet multibodies of them."""

from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np

from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import IDENTITY, inverse, position, quaternion
from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.physics.colliders import make_colliders
from sim_bridge.physics.joints import limit_joint
from sim_bridge.physics.registry import BodyRegistry, BulletJoint, BulletLink
from sim_bridge.world import Body, Joint

# Bullet's limit: the root and the links of one multibody.
MAX_PARTS = 128
# Bullet's limit of the velocities of a multibody, which is 100 m/s and rad/s unless it is set.
MAX_VELOCITY = 1e6
_KINDS = {"revolute": pybullet.JOINT_REVOLUTE, "prismatic": pybullet.JOINT_PRISMATIC}


@dataclass
class KinematicTree:
    """Bodies connected by joints; body 0 is the root.

    Attributes:
        bodies: The bodies, parents before children.
        joints: The joint of each body to its parent; None for the root.
        parents: Index of each body's parent; -1 for the root.
        frames: Pose (4, 4) of each body's joint frame in the body frame.
    """

    bodies: List[Body]
    joints: List[Optional[Joint]] = field(default_factory=lambda: [None])
    parents: List[int] = field(default_factory=lambda: [-1])
    frames: List[np.ndarray] = field(default_factory=lambda: [np.eye(4)])


def kinematic_trees(bodies: Sequence[Body], joints: Sequence[Joint]) -> List[KinematicTree]:
    """Group bodies into kinematic trees.

    A joint to the world gets a static root without shapes, named after the joint.

    Args:
        bodies: The bodies.
        joints: Joints between them or to the world; they must not form loops.
    """
    by_parent: Dict[str, List[Joint]] = {}
    for joint in joints:
        by_parent.setdefault(joint.parent, []).append(joint)
    by_name = {body.name: body for body in bodies}
    children = {joint.child for joint in joints}
    roots = [body for body in bodies if body.name not in children]
    trees = [_with_descendants(KinematicTree([root]), by_parent, by_name) for root in roots]
    for joint in by_parent.get("", ()):
        anchor = Body(joint.name, by_name[joint.child].pose_in_world, ())
        rooted = KinematicTree([anchor])
        _add_child(rooted, joint, 0, by_name)
        trees.append(_with_descendants(rooted, by_parent, by_name))
    return trees


def _with_descendants(
    tree: KinematicTree, by_parent: Dict[str, List[Joint]], by_name: Dict[str, Body]
) -> KinematicTree:
    at = 0
    while at < len(tree.bodies):
        for joint in by_parent.get(tree.bodies[at].name, ()):
            _add_child(tree, joint, at, by_name)
        at += 1
    return tree


def _add_child(tree: KinematicTree, joint: Joint, parent: int, by_name: Dict[str, Body]) -> None:
    tree.bodies.append(by_name[joint.child])
    tree.joints.append(joint)
    tree.parents.append(parent)
    tree.frames.append(joint.pose_in_child)


def build_multibody(
    bullet: BulletClient, registry: BodyRegistry, tree: KinematicTree, placement: np.ndarray
) -> int:
    """Create a multibody from a kinematic tree.

    Each body becomes a link of its parent's link. Shapes beyond Bullet's limit for one link become further
    links that are fixed to it.

    Args:
        bullet: The physics engine.
        registry: Receives the ids of the new links and joints.
        tree: The bodies and the joints between them.
        placement: Pose (4, 4) in the world of the frame in which the bodies' poses are given.

    Returns:
        Bullet's unique id of the multibody.

    Raises:
        WorldError: The tree has more parts than a Bullet multibody can have.
    """
    root = tree.bodies[0]
    centre = root.inertia.pose_in_body
    root_shape, *more = make_colliders(bullet, root.collisions, root.mass is not None, centre)
    links, indices = _child_links(bullet, tree)
    links += [_link(shape, IDENTITY, 0) for shape in more]
    if len(links) >= MAX_PARTS:
        raise WorldError(
            f"{root.name}: {len(links) + 1} parts are connected by joints, at most {MAX_PARTS} are supported"
        )
    is_static = all(body.mass is None for body in tree.bodies)
    placed = placement @ root.pose_in_world @ centre
    body_id = bullet.createMultiBody(
        baseMass=root.mass or 0.0,
        baseCollisionShapeIndex=root_shape,
        basePosition=position(placed),
        baseOrientation=quaternion(placed),
        # A Bullet rigid body costs far less per step than a multibody, but cannot have links.
        useMaximalCoordinates=int(is_static and not links),
        **{key: [link[key] for link in links] for key in (links[0] if links else {})},
    )
    if not is_static:
        registry.dynamic_bodies.add(body_id)
    _configure_parts(bullet, registry, tree, body_id, _bodies_of_links(tree, indices, links), indices)
    return body_id


def _configure_parts(
    bullet: BulletClient,
    registry: BodyRegistry,
    tree: KinematicTree,
    body_id: int,
    bodies: Dict[int, Body],
    indices: List[int],
) -> None:
    """Register the links and joints of a multibody and set what createMultiBody does not accept."""
    for index, body in bodies.items():
        registry.assign_link(body_id, index, body.name)
        registry.surfaces[body_id, index] = body.surface
        _set_dynamics(bullet, body_id, index)
    for index, body, joint in zip(indices, tree.bodies, tree.joints):
        registry.links[body.name] = BulletLink(body_id, index, body.inertia.pose_in_body)
        if body.inertia.moments is not None and body.mass is not None:
            bullet.changeDynamics(body_id, index, localInertiaDiagonal=body.inertia.moments.tolist())
        if joint is not None and joint.kind != "fixed":
            registry.joints[joint.name] = BulletJoint(body_id, index, joint)
            _configure_joint(bullet, body_id, index, joint)


def _child_links(bullet: BulletClient, tree: KinematicTree) -> Tuple[List[Dict[str, Any]], List[int]]:
    """Return the links of all bodies but the root, and the link index of each body, the root's first."""
    links: List[Dict[str, Any]] = []
    indices = [-1]
    for body, joint, parent, frame in list(zip(tree.bodies, tree.joints, tree.parents, tree.frames))[1:]:
        assert joint is not None, "only the root has no joint to a parent"
        shape, *more = make_colliders(bullet, body.collisions, True, frame)
        parent_body = tree.bodies[parent]
        parent_frame = parent_body.inertia.pose_in_body if parent == 0 else tree.frames[parent]
        in_parent = inverse(parent_body.pose_in_world @ parent_frame) @ body.pose_in_world @ frame
        start = in_parent @ inverse(_displaced(joint, joint.start))
        centre = inverse(frame) @ body.inertia.pose_in_body
        links.append(_link(shape, start, indices[parent] + 1, body.mass or 0.0, centre, joint))
        indices.append(len(links) - 1)
        links += [_link(part, IDENTITY, indices[-1] + 1) for part in more]
    return links, indices


def _bodies_of_links(tree: KinematicTree, indices: List[int], links: List[Dict[str, Any]]) -> Dict[int, Body]:
    """Return the body of each link; further links of a body are children of its first."""
    owners = dict(zip(indices, tree.bodies))
    for index, link in enumerate(links):
        owners.setdefault(index, owners[link["linkParentIndices"] - 1])
    return owners


def _set_dynamics(bullet: BulletClient, body_id: int, link_index: int) -> None:
    """Remove Bullet's own damping and its limit of velocities."""
    bullet.changeDynamics(
        body_id,
        link_index,
        linearDamping=0.0,
        angularDamping=0.0,
        jointDamping=0.0,
        maxJointVelocity=MAX_VELOCITY,
    )


def _configure_joint(bullet: BulletClient, body_id: int, link_index: int, joint: Joint) -> None:
    """Set a joint's friction, damping, limits and position; Bullet enables a motor on it by default."""
    bullet.setJointMotorControl2(body_id, link_index, pybullet.VELOCITY_CONTROL, force=joint.friction)
    bullet.changeDynamics(body_id, link_index, jointDamping=joint.damping)
    limit_joint(bullet, body_id, link_index, joint.lower, joint.upper)
    bullet.resetJointState(body_id, link_index, joint.start)


def _displaced(joint: Joint, displacement: float) -> np.ndarray:
    """Return the pose (4, 4) of a joint frame displaced along its axis, in the frame at position 0."""
    pose = np.eye(4)
    if joint.kind == "prismatic":
        pose[:3, 3] = displacement * joint.axis
    elif joint.kind == "revolute":
        turn = pybullet.getQuaternionFromAxisAngle(joint.axis.tolist(), displacement)
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
    """Return createMultiBody's arguments for a link; ``parent`` is 0 for the base, else 1 + a link index."""
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
