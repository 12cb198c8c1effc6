"""Forces on links and efforts on joints that last for a while."""

from dataclasses import dataclass
from typing import List

import numpy as np

from sim_bridge.physics.engine import Engine
from sim_bridge.physics.model_joints import ModelJoints
from sim_bridge.physics.models import Models


@dataclass(frozen=True, eq=False)
class LinkWrench:
    """A ``force``, N, at the centre of a link's mass, and a ``torque``, N m, from ``start`` to ``end``, s.

    Both (3,), along the axes of the world.
    """

    link: str
    force: np.ndarray
    torque: np.ndarray
    start: float
    end: float


@dataclass(frozen=True)
class JointEffort:
    """An ``effort``, N m or N, on a joint from ``start`` to ``end``, s."""

    joint: str
    effort: float
    start: float
    end: float


class Forces:
    """What pushes, now or later."""

    def __init__(self, engine: Engine, models: Models, joints: ModelJoints):
        self._engine = engine
        self._models = models
        self._joints = joints
        self._pushes: List[LinkWrench] = []
        self._joint_pushes: List[JointEffort] = []

    def push(self, push: LinkWrench) -> None:
        """Raises UnknownEntityError."""
        self._models.check_link(push.link)
        self._pushes.append(push)

    def apply_joint_effort(self, push: JointEffort) -> None:
        """Raises UnknownEntityError."""
        self._joints.get(push.joint)
        self._joint_pushes.append(push)

    def clear_link_wrenches(self, link: str) -> None:
        """Ends all pushes on a link."""
        self._pushes = [push for push in self._pushes if push.link != link]

    def clear_joint_efforts(self, joint: str) -> None:
        """Ends all efforts on a joint."""
        self._joint_pushes = [push for push in self._joint_pushes if push.joint != joint]

    def clear(self) -> None:
        """Ends everything."""
        self._pushes.clear()
        self._joint_pushes.clear()

    @property
    def are_pending(self) -> bool:
        """Whether anything pushes, or will."""
        return bool(self._pushes or self._joint_pushes)

    def apply(self, stamp: float) -> None:
        """Before the step of physics that begins at ``stamp``."""
        for push in self._pushes:
            if push.start <= stamp < push.end:
                self._engine.push(push.link, push.force.tolist(), push.torque.tolist())
        for effort in self._joint_pushes:
            if effort.start <= stamp < effort.end:
                self._engine.joints.push(effort.joint, effort.effort)
        self._pushes = [push for push in self._pushes if stamp < push.end]
        self._joint_pushes = [effort for effort in self._joint_pushes if stamp < effort.end]
