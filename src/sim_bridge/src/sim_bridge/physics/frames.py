"""Poses in Bullet: those of the centres of mass."""

from typing import Sequence

import numpy as np

from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.physics.registry import BulletLink


def matrix_of(point: Sequence[float], orientation: Sequence[float]) -> np.ndarray:
    """The pose (4, 4) of a point and a quaternion of Bullet's."""
    (x, y, z), r = point, pybullet.getMatrixFromQuaternion(orientation)
    return np.array((r[:3] + (x,), r[3:6] + (y,), r[6:] + (z,), (0.0, 0.0, 0.0, 1.0)))


def link_at(link: BulletLink, point: Sequence[float], orientation: Sequence[float]) -> np.ndarray:
    """The pose (4, 4) of a link whose centre of mass is at a point, turned by a quaternion of Bullet's."""
    if link.offset is None:
        return matrix_of(point, orientation) @ link.from_centre
    (x, y, z), (a, b, c) = point, link.offset  # plain numbers are quicker
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
    """Where the centre of mass of the root is that a link hangs on, (4, 4) in the world."""
    return matrix_of(*bullet.getBasePositionAndOrientation(link.number))


def centre_of_mass_of(bullet: BulletClient, link: BulletLink) -> np.ndarray:
    """Where the centre of a link's mass is, with its principal axes, (4, 4) in the world."""
    if link.index < 0:
        return root_pose_of(bullet, link)
    return matrix_of(*bullet.getLinkState(link.number, link.index, computeForwardKinematics=1)[:2])
