"""Wrenches on links and efforts on joints that act for a given time."""

from dataclasses import dataclass
from typing import List

import numpy as np

from sim_bridge.physics.engine import Engine
from sim_bridge.physics.model_joints import ModelJoints
from sim_bridge.physics.models import Models


@dataclass(frozen=True, eq=False)
class LinkWrench:
    """A wrench on a link (gazebo_msgs/ApplyBodyWrench).

    Attributes:
        link: Name of the link.
        force: Force (3,) at its centre of mass, in the world frame [N].
        torque: Torque (3,), in the world frame [N m].
        start: Simulated time at which it begins [s].
        end: Simulated time at which it ends [s].
    """

    link: str
    force: np.ndarray
    torque: np.ndarray
    start: float
    end: float


@dataclass(frozen=True)
class JointEffort:
    """An effort on a joint (gazebo_msgs/ApplyJointEffort).

    Attributes:
        joint: Name of the joint.
        effort: Torque or force [N m or N].
        start: Simulated time at which it begins [s].
        end: Simulated time at which it ends [s].
    """

    joint: str
    effort: float
    start: float
    end: float


class Forces:
    """The wrenches and efforts that act now or later.

    Args:
        engine: The physics engine.
        models: Checks the names of links.
        joints: Checks the names of joints.
    """

    def __init__(self, engine: Engine, models: Models, joints: ModelJoints):
        self._engine = engine
        self._models = models
        self._joints = joints
        self._wrenches: List[LinkWrench] = []
        self._efforts: List[JointEffort] = []

    def apply_link_wrench(self, wrench: LinkWrench) -> None:
        """Schedule a wrench, in addition to those on the same link.

        Raises:
            UnknownEntityError: There is no such link.
        """
        self._models.check_link(wrench.link)
        self._wrenches.append(wrench)

    def apply_joint_effort(self, effort: JointEffort) -> None:
        """Schedule an effort, in addition to those on the same joint.

        Raises:
            UnknownEntityError: There is no such joint.
        """
        self._joints.get(effort.joint)
        self._efforts.append(effort)

    def clear_link_wrenches(self, link: str) -> None:
        """Remove all wrenches on a link."""
        self._wrenches = [wrench for wrench in self._wrenches if wrench.link != link]

    def clear_joint_efforts(self, joint: str) -> None:
        """Remove all efforts on a joint."""
        self._efforts = [effort for effort in self._efforts if effort.joint != joint]

    def clear(self) -> None:
        """Remove all wrenches and efforts."""
        self._wrenches.clear()
        self._efforts.clear()

    @property
    def are_pending(self) -> bool:
        """Whether any wrench or effort acts now or will act."""
        return bool(self._wrenches or self._efforts)

    def apply(self, stamp: float) -> None:
        """Apply the active wrenches and efforts for one physics step, and remove those that have ended.

        Args:
            stamp: Simulated time at the beginning of the step [s].
        """
        for wrench in self._wrenches:
            if wrench.start <= stamp < wrench.end:
                self._engine.apply_wrench(wrench.link, wrench.force.tolist(), wrench.torque.tolist())
        for effort in self._efforts:
            if effort.start <= stamp < effort.end:
                self._engine.joints.apply_effort(effort.joint, effort.effort)
        self._wrenches = [wrench for wrench in self._wrenches if stamp < wrench.end]
        self._efforts = [effort for effort in self._efforts if stamp < effort.end]
