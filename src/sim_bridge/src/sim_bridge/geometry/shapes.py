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
VisualShape = Union[Shape, MeshFile]


def scaled(shape: VisualShape, scale: Tuple[float, float, float]) -> VisualShape:
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


def outline(shape: Shape) -> np.ndarray:
    """The outermost points (N, 3) of a solid, on a circle every 15 degrees; none of what has no end."""
    if isinstance(shape, Mesh):
        return shape.vertices
    if isinstance(shape, Box):
        signs = np.array(np.meshgrid(*[(-0.5, 0.5)] * 3)).reshape(3, -1).T
        return signs * np.asarray(shape.size)
    if isinstance(shape, Cylinder):
        rim = shape.radius * _CIRCLE
        return np.vstack([rim + [0.0, 0.0, height] for height in (-shape.length / 2.0, shape.length / 2.0)])
    if isinstance(shape, Sphere):
        return shape.radius * np.vstack([_CIRCLE, np.roll(_CIRCLE, 1, axis=1), np.roll(_CIRCLE, 2, axis=1)])
    return np.empty((0, 3))


_ANGLES = np.radians(np.arange(0.0, 360.0, 15.0))
_CIRCLE = np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES), np.zeros(len(_ANGLES))])
