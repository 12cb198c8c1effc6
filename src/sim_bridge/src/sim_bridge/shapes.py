"""Solid shapes, each centred on its own frame."""

from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Tuple, Union

import numpy as np


@dataclass(frozen=True)
class Box:
    """Lengths along x, y and z, metres."""

    size: Tuple[float, float, float]


@dataclass(frozen=True)
class Cylinder:
    """Axis along z, metres."""

    radius: float
    length: float


@dataclass(frozen=True)
class Sphere:
    radius: float


@dataclass(frozen=True)
class Plane:
    """Everything on the far side of an endless plane through the frame's origin."""

    normal: Tuple[float, float, float] = (0.0, 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles: ``vertices`` (N, 3) metres, ``triangles`` (M, 3) indices into them.

    ``colours``: (M, 3) of the triangles, red, green, blue, 0 to 1; None if they have none of their own.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    colours: Optional[np.ndarray] = None


@dataclass(frozen=True)
class MeshFile:
    """A mesh in a file: its part named ``submesh`` (all if empty), put at its centre if ``centred``."""

    path: Path
    scale: Tuple[float, float, float] = (1.0, 1.0, 1.0)
    submesh: str = ""
    centred: bool = False


Shape = Union[Box, Cylinder, Sphere, Plane, Mesh]
Look = Union[Shape, MeshFile]


def scaled(shape: Look, scale: Tuple[float, float, float]) -> Look:
    """A shape stretched along its axes as Gazebo does it: what is round stays round."""
    x, y, z = scale
    if isinstance(shape, Box):
        return Box((shape.size[0] * x, shape.size[1] * y, shape.size[2] * z))
    if isinstance(shape, Cylinder):
        return Cylinder(shape.radius * max(x, y), shape.length * z)
    if isinstance(shape, Sphere):
        return Sphere(shape.radius * max(x, y, z))
    if isinstance(shape, MeshFile):
        a, b, c = shape.scale
        return MeshFile(shape.path, (a * x, b * y, c * z), shape.submesh, shape.centred)
    if isinstance(shape, Mesh):
        return Mesh(shape.vertices * scale, shape.triangles, shape.colours)
    return shape
