"""Reads the structure of a robot from a driven SDF model."""

from typing import List, Tuple

import numpy as np

from sim_bridge.description.structure import GazeboElements, RobotJoint, RobotLink, RobotStructure
from sim_bridge.geometry.pose3 import inverse, transform_points
from sim_bridge.geometry.shapes import outline_points
from sim_bridge.world import Body, DrivenModel


def read_sdf(model: DrivenModel) -> Tuple[RobotStructure, GazeboElements, np.ndarray]:
    """Read the structure of a robot from a driven SDF model.

    Args:
        model: The model.

    Returns:
        The link tree, the <plugin> and <sensor> elements, and the pose (4, 4) of the root link in the world.

    Raises:
        RobotError: The links and joints are not one tree.
    """
    elements = GazeboElements(model.element)
    elements.add(model.element, "")
    for link in model.element.children("link"):
        elements.add(link, link.name)
    poses = {body.name: body.pose_in_world for body in model.bodies}
    joints = [
        RobotJoint(
            _inner(joint.name),
            _inner(joint.parent),
            _inner(joint.child),
            inverse(poses[joint.parent]) @ poses[joint.child],
            joint.pose_in_child[:3, :3] @ joint.axis,
        )
        for joint in model.joints
        if joint.parent
    ]
    structure = RobotStructure(model.name, [_link(body) for body in model.bodies], joints)
    return structure, elements, poses[f"{model.name}::{structure.root}"]


def _inner(name: str) -> str:
    """Return a name without its model's."""
    return name.split("::", 1)[1]


def _link(body: Body) -> RobotLink:
    pose, mass = body.inertia.pose_in_body, body.mass or 0.0
    moments = _moments_of_a_box(body, mass) if body.inertia.moments is None else body.inertia.moments
    inertia = pose[:3, :3] @ np.diag(moments) @ pose[:3, :3].T
    return RobotLink(_inner(body.name), mass, pose[:3, 3], inertia, body.collisions)


def _moments_of_a_box(body: Body, mass: float) -> np.ndarray:
    """Return the moments (3,) of the bounding box of a link's collisions [kg m^2]."""
    points: List[np.ndarray] = [
        transform_points(part.pose_in_body, outline_points(part.shape)) for part in body.collisions
    ]
    if not points:
        return np.zeros(3)
    x, y, z = np.ptp(np.vstack(points), axis=0) ** 2
    return mass / 12.0 * np.array([y + z, x + z, x + y])
