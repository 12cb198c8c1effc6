"""Groups bodies and joints into kinematic trees, of which Bullet makes multibodies."""

from dataclasses import dataclass, field
from typing import Dict, List, Optional, Sequence

import numpy as np

from sim_bridge.world import Body, Joint


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

    def is_fixed(self) -> bool:
        """Return whether the root is static."""
        return self.bodies[0].mass is None


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
