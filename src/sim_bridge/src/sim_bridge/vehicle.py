"""A wheeled robot among the bodies of an engine."""

from typing import Sequence, Set, Tuple

import numpy as np

from planar import Twist2
from sim_bridge.engine import Engine, Motion
from sim_bridge.errors import RobotError, WorldError
from sim_bridge.pose3 import position
from sim_bridge.robots import RobotProfile
from sim_bridge.urdf_reader import read_robot

# Metres that a robot at its start may reach into what it stands on.
START_DEPTH = 0.01
# Metres above and below the robot's start within which there must be a floor.
FLOOR_SEARCH = 0.1
# A contact whose normal rises more steeply than this carries the robot; it is no collision.
SUPPORTING_NORMAL_Z = 0.7


class Vehicle:
    """The robot ``name``; it starts with its base frame at ``base_in_space``, (4, 4)."""

    def __init__(self, engine: Engine, name: str, robot: RobotProfile, base_in_space: np.ndarray):
        model = read_robot(robot.description())
        joints = (robot.drive.left_joint, robot.drive.right_joint)
        for joint in joints:
            if joint not in model.wheels:
                raise RobotError(f"robot {robot.name}: no wheel on a joint named {joint!r}")
        engine.add_robot(name, model, joints, base_in_space)
        self.name = name
        self.base = f"{name}::{model.base.name}"
        self.links = (self.base, *(f"{name}::{model.wheels[joint].part.name}" for joint in joints))
        self.collisions = model.base.collisions
        self._efforts = [model.wheels[joint].effort for joint in joints]
        self._engine = engine

    def drive(self, wheel_speeds: Sequence[float]) -> None:
        """The motors aim at these speeds of the left and right wheel, rad/s."""
        self._engine.drive_wheels(self.base, wheel_speeds, self._efforts)

    def motion(self) -> Motion:
        """Of the base frame."""
        return self._engine.motion_of(self.base)

    def wheels(self) -> Tuple[Tuple[float, float], Tuple[float, float]]:
        """Angles, rad, and speeds, rad/s, of the left and right wheel."""
        return self._engine.wheels(self.base, len(self._efforts))  # type: ignore[return-value]

    def touched(self) -> Set[str]:
        """Names of the links the robot bumps into; what it stands on is not among them."""
        return {
            contact.link
            for contact in self._engine.contacts(self.base)
            if contact.depth >= 0.0 and abs(contact.normal_z) < SUPPORTING_NORMAL_Z
        }

    def check_start(self) -> None:
        """Raises WorldError if the robot has no floor to stand on or stands in something."""
        self._engine.find_contacts()
        x, y, z = position(self._engine.pose_of(self.base))
        contacts = self._engine.contacts(self.base)
        inside = {contact.link for contact in contacts if contact.depth > START_DEPTH} | self.touched()
        if inside:
            raise WorldError(f"the robot would start at ({x:g}, {y:g}), inside {', '.join(sorted(inside))}")
        if self._engine.hit_share((x, y, z + FLOOR_SEARCH), (x, y, z - FLOOR_SEARCH)) >= 1.0:
            raise WorldError(f"the robot would start at ({x:g}, {y:g}), where there is no floor")


def twist_in_base(motion: Motion) -> Twist2:
    """Velocity of the base frame's origin along its own x axis, and turn rate."""
    return Twist2(float(motion.linear[:2] @ motion.pose[:2, 0]), float(motion.angular[2]))
