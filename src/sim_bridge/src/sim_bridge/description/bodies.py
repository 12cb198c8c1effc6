"""Bodies and joints of a robot, for the physics engine."""

from typing import Tuple

import numpy as np

from sim_bridge.description.structure import RobotModel
from sim_bridge.geometry.pose3 import IDENTITY
from sim_bridge.world import Body, Inertia, Joint, SurfaceProperties

# The base has no friction: its casters roll in any direction, and its sides must not climb walls.
SLIDING = SurfaceProperties(friction=0.0)


def bodies_of(model: RobotModel, name: str) -> Tuple[Tuple[Body, ...], Tuple[Joint, ...]]:
    """Return the rigid bodies of a robot, for the physics engine.

    Args:
        model: Base and wheels.
        name: Name of the robot's model, the prefix of the names of links and joints.

    Returns:
        The base and the wheels, with poses in the base frame, and the joints between them. The mass of a
        wheel is at its hub.
    """
    base = model.base
    centre = np.eye(4)
    centre[:3, 3] = base.centre_of_mass
    bodies = [
        Body(
            f"{name}::{base.name}",
            IDENTITY,
            base.collisions,
            base.mass,
            SLIDING,
            inertia=Inertia(centre, base.inertia),
            has_gravity=bool(model.wheels),  # an omnidirectional base keeps its height
        )
    ]
    joints = []
    for joint_name, wheel in model.wheels.items():
        link = f"{name}::{wheel.part.name}"
        inertia, surface = Inertia(moments=wheel.part.inertia), SurfaceProperties(wheel.friction)
        part = wheel.part
        bodies.append(Body(link, wheel.origin_in_base, part.collisions, part.mass, surface, inertia=inertia))
        joints.append(Joint(f"{name}::{joint_name}", "revolute", bodies[0].name, link, IDENTITY, wheel.axis))
    return tuple(bodies), tuple(joints)
