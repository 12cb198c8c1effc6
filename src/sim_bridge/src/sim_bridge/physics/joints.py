"""Movable joints of the physics engine."""

from typing import List, NamedTuple, Sequence, Tuple

import numpy as np

from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.physics.registry import BodyRegistry, BulletJoint

# Force with which Bullet keeps a joint within its limits [N m or N].
LIMIT_FORCE = 1e4
# Position that stands for an infinite limit beside a finite one [rad or m].
FAR = 1e9


class JointState(NamedTuple):
    """State of a joint.

    Attributes:
        position: Position [rad or m].
        speed: Speed [rad/s or m/s].
    """

    position: float
    speed: float


class Joints:
    """Access to movable joints by name."""

    def __init__(self, bullet: BulletClient, registry: BodyRegistry):
        self._bullet = bullet
        self._registry = registry

    def state(self, name: str) -> JointState:
        """Return the state of a joint."""
        joint = self._registry.joints[name]
        return JointState(*self._bullet.getJointState(joint.body_id, joint.link_index)[:2])

    def set_state(self, name: str, state: JointState) -> None:
        """Set the position and speed of a joint; its child links move with it.

        Args:
            name: Name of the joint, ``model::joint``.
            state: Position and speed.
        """
        joint = self._registry.joints[name]
        self._bullet.resetJointState(joint.body_id, joint.link_index, state.position, state.speed)

    def apply_effort(self, name: str, effort: float) -> None:
        """Apply an effort during the next physics step.

        Args:
            name: Name of the joint.
            effort: Torque or force [N m or N], clipped to the joint's limit.
        """
        joint = self._registry.joints[name]
        limit = joint.joint.effort
        self._bullet.setJointMotorControl2(
            joint.body_id, joint.link_index, pybullet.TORQUE_CONTROL, force=max(-limit, min(effort, limit))
        )

    def set_limits(self, name: str, lower: float, upper: float, damping: float) -> None:
        """Set the limits and the damping of a joint.

        Args:
            name: Name of the joint.
            lower: Lower limit [rad or m].
            upper: Upper limit [rad or m].
            damping: Viscous damping [N m s/rad or N s/m].
        """
        joint = self._registry.joints[name]
        limit_joint(self._bullet, joint.body_id, joint.link_index, lower, upper)
        self._bullet.changeDynamics(joint.body_id, joint.link_index, jointDamping=damping)

    def motors(self, names: Sequence[str]) -> "Motors":
        """Return a motor controller for joints of the same multibody."""
        return Motors(self._bullet, [self._registry.joints[name] for name in names])


class Motors:
    """Velocity control of several joints of one multibody.

    Args:
        bullet: The physics engine.
        joints: The joints, at least one.
    """

    def __init__(self, bullet: BulletClient, joints: Sequence[BulletJoint]):
        self._bullet = bullet
        self._body_id = joints[0].body_id
        self._indices: List[int] = [joint.link_index for joint in joints]

    def set_velocities(self, speeds: Sequence[float], efforts: Sequence[float]) -> None:
        """Set the targets of the motors, in the order of the joints.

        Args:
            speeds: Target speeds [rad/s].
            efforts: Largest torques [N m].
        """
        self._bullet.setJointMotorControlArray(
            self._body_id, self._indices, pybullet.VELOCITY_CONTROL, targetVelocities=speeds, forces=efforts
        )

    def reset(self, angles: Sequence[float]) -> None:
        """Set the angles of the joints [rad], in their order, at rest."""
        for index, angle in zip(self._indices, angles):
            self._bullet.resetJointState(self._body_id, index, angle, 0.0)

    def states(self) -> Tuple[Tuple[float, ...], Tuple[float, ...]]:
        """Return the angles [rad] and the speeds [rad/s] of the joints, in their order."""
        states = self._bullet.getJointStates(self._body_id, self._indices)
        return tuple(state[0] for state in states), tuple(state[1] for state in states)


def limit_joint(bullet: BulletClient, body_id: int, link_index: int, lower: float, upper: float) -> None:
    """Set the limits of a joint, of which one or both may be infinite.

    Args:
        bullet: The physics engine.
        body_id: Bullet's unique id of the multibody.
        link_index: Bullet's index of the joint and its child link.
        lower: Lower limit [rad or m].
        upper: Upper limit [rad or m].
    """
    if min(-lower, upper) < np.inf:
        bullet.changeDynamics(
            body_id,
            link_index,
            jointLowerLimit=max(lower, -FAR),
            jointUpperLimit=min(upper, FAR),
            jointLimitForce=LIMIT_FORCE,
        )
