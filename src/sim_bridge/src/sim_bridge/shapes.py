"""Solid shapes, each centred on its own frame."""

from dataclasses import dataclass
from typing import Tuple, Union

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
    """Triangles: ``vertices`` (N, 3) metres, ``triangles`` (M, 3) indices into them."""

    vertices: np.ndarray
    triangles: np.ndarray


Shape = Union[Box, Cylinder, Sphere, Plane, Mesh]
