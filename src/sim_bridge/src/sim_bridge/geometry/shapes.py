"""Geometric shapes, each centred at the origin of its frame."""

from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Tuple, Union

import numpy as np


@dataclass(frozen=True)
class Box:
    """A box.

    Attributes:
        size: Lengths along x, y and z [m].
    """

    size: Tuple[float, float, float]


@dataclass(frozen=True)
class Cylinder:
    """A cylinder along z.

    Attributes:
        radius: Radius [m].
        length: Length along z [m].
    """

    radius: float
    length: float


@dataclass(frozen=True)
class Sphere:
    """A sphere.

    Attributes:
        radius: Radius [m].
    """

    radius: float


@dataclass(frozen=True)
class Plane:
    """The half-space below an infinite plane through the origin.

    Attributes:
        normal: Unit vector out of the half-space.
    """

    normal: Tuple[float, float, float] = (0.0, 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh.

    Attributes:
        vertices: Positions (N, 3) [m].
        triangles: Vertex indices (M, 3).
        colours: Red, green, blue (M, 3) of the triangles, 0 to 1; None for no colours.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    colours: Optional[np.ndarray] = None


@dataclass(frozen=True)
class MeshFile:
    """A mesh in a file.

    Attributes:
        path: The file.
        scale: Scale factors along x, y and z.
        submesh: Name of the part to use; empty for all.
        centred: Whether the part's centre is moved to the origin.
    """

    path: Path
    scale: Tuple[float, float, float] = (1.0, 1.0, 1.0)
    submesh: str = ""
    centred: bool = False


Shape = Union[Box, Cylinder, Sphere, Plane, Mesh]
VisualShape = Union[Shape, MeshFile]


def scaled(shape: VisualShape, scale: Tuple[float, float, float]) -> VisualShape:
    """Return a scaled shape; as in Gazebo, cylinders and spheres stay round.

    Args:
        shape: The shape.
        scale: Scale factors along its x, y and z axes.
    """
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


def outline_points(shape: Shape) -> np.ndarray:
    """Return the extreme points (N, 3) of a solid, on circles every 15 degrees; none for a plane."""
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
