"""<inertial> elements."""

import numpy as np

from sim_bridge.sdf.element import Element
from sim_bridge.world import Inertia

# SDF's own default, kg.
DEFAULT_MASS = 1.0


def read_mass(link: Element) -> float:
    mass = link.child("inertial", "mass")
    return mass.lengths(1)[0] if mass is not None else DEFAULT_MASS


def read_inertia(link: Element) -> Inertia:
    """The centre of mass and the principal moments of a link. Raises WorldError if no body can have them."""
    inertial = link.child("inertial")
    pose = inertial.raw_pose() if inertial is not None else None
    pose = np.eye(4) if pose is None else pose
    matrix = inertial.child("inertia") if inertial is not None else None
    if matrix is None:
        return Inertia(pose)
    xx, xy, xz, yy, yz, zz = (
        matrix.number(f"i{axes}", default=1.0 if axes[0] == axes[1] else 0.0)
        for axes in ("xx", "xy", "xz", "yy", "yz", "zz")
    )
    moments, axes_xyz = np.linalg.eigh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if moments[0] <= 0.0:
        raise matrix.error(f"moments of inertia must be positive, got {', '.join(f'{m:g}' for m in moments)}")
    turned = pose.copy()
    turned[:3, :3] = pose[:3, :3] @ (axes_xyz * np.sign(np.linalg.det(axes_xyz)))
    return Inertia(turned, moments)
