"""The joints of an engine that move."""

from typing import List, NamedTuple, Sequence, Tuple

import numpy as np

from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.physics.registry import BodyRegistry, BulletJoint

# N m/rad or N/m of what holds a joint within its limits.
LIMIT_FORCE = 1e4


class JointState(NamedTuple):
    """``position`` in rad or m, ``speed`` in rad/s or m/s."""

    position: float
    speed: float


class Joints:
    """Reads, moves, pushes and limits joints by their names."""

    def __init__(self, bullet: BulletClient, register: BodyRegistry):
        self._bullet = bullet
        self._register = register

    def state(self, name: str) -> JointState:
        joint = self._register.joints[name]
        return JointState(*self._bullet.getJointState(joint.number, joint.index)[:2])

    def set_state(self, name: str, state: JointState) -> None:
        """Puts a joint to a position, with all that hangs on it."""
        joint = self._register.joints[name]
        self._bullet.resetJointState(joint.number, joint.index, state.position, state.speed)

    def push(self, name: str, effort: float) -> None:
        """``effort``: N m or N, at most what the joint bears; for the next step only."""
        joint = self._register.joints[name]
        limit = joint.joint.effort
        self._bullet.setJointMotorControl2(
            joint.number, joint.index, pybullet.TORQUE_CONTROL, force=max(-limit, min(effort, limit))
        )

    def set_limits(self, name: str, lower: float, upper: float, damping: float) -> None:
        """Limits in rad or m, ``damping`` in N m s/rad or N s/m."""
        joint = self._register.joints[name]
        limit_joint(self._bullet, joint.number, joint.index, lower, upper)
        self._bullet.changeDynamics(joint.number, joint.index, jointDamping=damping)

    def motors(self, names: Sequence[str]) -> "Motors":
        """Of joints that belong to the same thing."""
        return Motors(self._bullet, [self._register.joints[name] for name in names])


class Motors:
    """Turns some joints of one thing."""

    def __init__(self, bullet: BulletClient, joints: Sequence[BulletJoint]):
        self._bullet = bullet
        self._number = joints[0].number
        self._indices: List[int] = [joint.index for joint in joints]

    def set_velocities(self, speeds: Sequence[float], efforts: Sequence[float]) -> None:
        """The motors aim at ``speeds``, rad/s, with at most ``efforts``, N m."""
        self._bullet.setJointMotorControlArray(
            self._number, self._indices, pybullet.VELOCITY_CONTROL, targetVelocities=speeds, forces=efforts
        )

    def states(self) -> Tuple[Tuple[float, ...], Tuple[float, ...]]:
        """Angles, rad, and speeds, rad/s."""
        states = self._bullet.getJointStates(self._number, self._indices)
        return tuple(state[0] for state in states), tuple(state[1] for state in states)


def limit_joint(bullet: BulletClient, number: int, index: int, lower: float, upper: float) -> None:
    """Lets a joint move between two positions, rad or m; not limited if they are infinitely far apart."""
    if upper - lower < np.inf:
        bullet.changeDynamics(
            number, index, jointLowerLimit=lower, jointUpperLimit=upper, jointLimitForce=LIMIT_FORCE
        )
