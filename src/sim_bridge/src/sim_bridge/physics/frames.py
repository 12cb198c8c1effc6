"""Poses of links from Bullet, which reports those of their centres of mass."""

from typing import Sequence

import numpy as np

from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.physics.registry import BodyRegistry, BulletLink


def matrix_of(point: Sequence[float], orientation: Sequence[float]) -> np.ndarray:
    """Return the pose (4, 4) of a position and an orientation.

    Args:
        point: Position (3,) [m].
        orientation: Unit quaternion (x, y, z, w).
    """
    (x, y, z), r = point, pybullet.getMatrixFromQuaternion(orientation)
    return np.array((r[:3] + (x,), r[3:6] + (y,), r[6:] + (z,), (0.0, 0.0, 0.0, 1.0)))


def link_at(link: BulletLink, point: Sequence[float], orientation: Sequence[float]) -> np.ndarray:
    """Return the pose (4, 4) of a link's frame in the world.

    Args:
        link: The link.
        point: Position (3,) of its centre of mass in the world [m].
        orientation: Orientation of its principal axes in the world, quaternion (x, y, z, w).
    """
    if link.offset is None:
        return matrix_of(point, orientation) @ link.from_centre
    (x, y, z), (a, b, c) = point, link.offset  # plain floats are faster here than numpy
    xx, xy, xz, yx, yy, yz, zx, zy, zz = pybullet.getMatrixFromQuaternion(orientation)
    return np.array(
        (
            (xx, xy, xz, x + xx * a + xy * b + xz * c),
            (yx, yy, yz, y + yx * a + yy * b + yz * c),
            (zx, zy, zz, z + zx * a + zy * b + zz * c),
            (0.0, 0.0, 0.0, 1.0),
        )
    )


def root_pose_of(bullet: BulletClient, link: BulletLink) -> np.ndarray:
    """Return the pose (4, 4) in the world of the centre of mass of a link's root."""
    return matrix_of(*bullet.getBasePositionAndOrientation(link.body_id))


def centre_of_mass_of(bullet: BulletClient, link: BulletLink) -> np.ndarray:
    """Return the pose (4, 4) in the world of a link's centre of mass and principal axes."""
    if link.link_index < 0:
        return root_pose_of(bullet, link)
    return matrix_of(*bullet.getLinkState(link.body_id, link.link_index, computeForwardKinematics=1)[:2])


def is_any_moving(bullet: BulletClient, registry: BodyRegistry, speed: float) -> bool:
    """Return whether physics moves a link along or about an axis faster than ``speed`` [m/s and rad/s]."""
    moved = (link for link in registry.links.values() if not registry.is_static(link.body_id))
    return any(np.abs(velocities_of(bullet, link)).max() > speed for link in moved)


def velocities_of(bullet: BulletClient, link: BulletLink) -> np.ndarray:
    """Return the linear and angular velocity (2, 3) of a link's centre of mass [m/s and rad/s]."""
    if link.link_index < 0:
        return np.array(bullet.getBaseVelocity(link.body_id))
    return np.array(bullet.getLinkState(link.body_id, link.link_index, computeLinkVelocity=1)[6:8])
