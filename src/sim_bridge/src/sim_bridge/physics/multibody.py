"""Bodies and the joints between them as the trees that Bullet wants."""

from dataclasses import dataclass, field
from typing import Dict, List, Optional, Sequence

import numpy as np

from sim_bridge.world import Body, Joint


@dataclass
class KinematicTree:
    """Bodies that hang together: body i by ``joints[i]`` on the body number ``parents[i]``; 0 is the root.

    ``frames``: (4, 4) of each body's own frame in the body: where its joint is.
    """

    bodies: List[Body]
    joints: List[Optional[Joint]] = field(default_factory=lambda: [None])
    parents: List[int] = field(default_factory=lambda: [-1])
    frames: List[np.ndarray] = field(default_factory=lambda: [np.eye(4)])

    def is_fixed(self) -> bool:
        """Whether the root never moves."""
        return self.bodies[0].mass is None


def kinematic_trees(bodies: Sequence[Body], joints: Sequence[Joint]) -> List[KinematicTree]:
    """The trees that ``joints``, which close no loops, make of ``bodies``; parents come before children.

    A body on a joint to the world hangs on a root of no shape that never moves, named after the joint.
    """
    by_parent: Dict[str, List[Joint]] = {}
    for joint in joints:
        by_parent.setdefault(joint.parent, []).append(joint)
    by_name = {body.name: body for body in bodies}
    hanging = {joint.child for joint in joints}
    roots = [body for body in bodies if body.name not in hanging]
    trees = [_tree(KinematicTree([root]), by_parent, by_name) for root in roots]
    for joint in by_parent.get("", ()):
        anchor = Body(joint.name, by_name[joint.child].pose_in_world, ())
        held = KinematicTree([anchor])
        _hang(held, joint, 0, by_name)
        trees.append(_tree(held, by_parent, by_name))
    return trees


def _tree(tree: KinematicTree, by_parent: Dict[str, List[Joint]], by_name: Dict[str, Body]) -> KinematicTree:
    at = 0
    while at < len(tree.bodies):
        for joint in by_parent.get(tree.bodies[at].name, ()):
            _hang(tree, joint, at, by_name)
        at += 1
    return tree


def _hang(tree: KinematicTree, joint: Joint, parent: int, by_name: Dict[str, Body]) -> None:
    tree.bodies.append(by_name[joint.child])
    tree.joints.append(joint)
    tree.parents.append(parent)
    tree.frames.append(joint.pose_in_child)
