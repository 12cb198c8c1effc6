"""Reads <inertial> elements."""

import numpy as np

from sim_bridge.errors import WorldError
from sim_bridge.sdf.element import Element
from sim_bridge.sdf.warnings import SkippedElements
from sim_bridge.world import Inertia

# SDF's default [kg].
DEFAULT_MASS = 1.0


def read_mass(link: Element) -> float:
    """Return the mass of a link [kg].

    Raises:
        WorldError: It is not a positive number.
    """
    mass = link.child("inertial", "mass")
    return mass.lengths(1)[0] if mass is not None else DEFAULT_MASS


def read_inertia(link: Element, warnings: SkippedElements) -> Inertia:
    """Return the centre of mass and the principal moments of a link.

    Moments that are not positive, as in many worlds for links that never move, are ignored with a warning.

    Args:
        link: The <link>.
        warnings: Receives the warning.
    """
    inertial = link.child("inertial")
    if inertial is None:
        return Inertia()
    raw = inertial.raw_pose()
    pose = np.eye(4) if raw is None else raw
    matrix = inertial.child("inertia")
    if matrix is None:
        return Inertia(pose)
    try:
        moments, axes_xyz = np.linalg.eigh(_matrix(matrix))
    except WorldError as error:
        warnings.skip(matrix, f"ignored: {error}", kind="inertia")
        return Inertia(pose)
    if moments[0] <= 0.0:
        warnings.skip(matrix, "ignored: its moments are not positive", kind="inertia")
        return Inertia(pose)
    turned = pose.copy()
    turned[:3, :3] = pose[:3, :3] @ (axes_xyz * np.sign(np.linalg.det(axes_xyz)))
    return Inertia(turned, moments)


def _matrix(inertia: Element) -> np.ndarray:
    """Return the inertia matrix (3, 3). Raises WorldError."""
    xx, xy, xz, yy, yz, zz = (
        inertia.number(f"i{axes}", default=1.0 if axes[0] == axes[1] else 0.0)
        for axes in ("xx", "xy", "xz", "yy", "yz", "zz")
    )
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
