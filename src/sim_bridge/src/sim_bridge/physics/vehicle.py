"""A wheeled robot among the bodies of an engine."""

from typing import List, Tuple

import numpy as np

from planar import Twist2
from sim_bridge.description import RobotProfile
from sim_bridge.errors import WorldError
from sim_bridge.geometry.pose3 import position
from sim_bridge.physics.engine import Contact, Engine, Motion

# Metres that a robot at its start may reach into what it stands on.
START_DEPTH = 0.01
# A contact whose normal rises more steeply than this carries the robot; it is no collision.
SUPPORTING_NORMAL_Z = 0.7


class Vehicle:
    """The robot ``name``; it starts with its base frame at ``base_in_space``, (4, 4)."""

    def __init__(self, engine: Engine, name: str, robot: RobotProfile, base_in_space: np.ndarray):
        model, drive = robot.model, robot.drive
        engine.add_robot(name, model, base_in_space)
        self.name = name
        self.base = f"{name}::{model.base.name}"
        self.links = (self.base, *(f"{name}::{wheel.part.name}" for wheel in model.wheels.values()))
        self.collisions = model.base.collisions
        self.left_count = len(drive.left_joints)
        self._efforts = [drive.torque] * len(drive.joints)
        self._engine = engine

    def drive(self, left_speed: float, right_speed: float) -> None:
        """The motors aim at these speeds of the wheels on the left and the right, rad/s."""
        right_count = len(self._efforts) - self.left_count
        speeds = [left_speed] * self.left_count + [right_speed] * right_count
        self._engine.drive_wheels(self.base, speeds, self._efforts)

    def motion(self) -> Motion:
        """Of the base frame."""
        return self._engine.motion_of(self.base)

    def wheels(self) -> Tuple[Tuple[float, ...], Tuple[float, ...]]:
        """Angles, rad, and speeds, rad/s, of the wheels, those on the left first."""
        return self._engine.wheels(self.base, len(self._efforts))

    def bumps(self) -> List[Contact]:
        """Where the robot touches things; what it stands on is not among them."""
        return [
            contact
            for contact in self._engine.contacts(self.base)
            if contact.depth >= 0.0 and abs(contact.normal_z) < SUPPORTING_NORMAL_Z
        ]

    def check_start(self) -> None:
        """Raises WorldError if the robot stands in something."""
        self._engine.find_contacts()
        x, y, _ = position(self._engine.pose_of(self.base))
        sunk = [contact for contact in self._engine.contacts(self.base) if contact.depth > START_DEPTH]
        inside = {contact.link for contact in sunk + self.bumps()}
        if inside:
            raise WorldError(f"the robot would start at ({x:g}, {y:g}), inside {', '.join(sorted(inside))}")


def twist_in_base(motion: Motion) -> Twist2:
    """Velocity of the base frame's origin along its own x axis, and turn rate."""
    return Twist2(float(motion.linear[:2] @ motion.pose[:2, 0]), float(motion.angular[2]))
