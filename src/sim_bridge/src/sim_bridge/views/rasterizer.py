"""Triangles drawn into pictures of colour and depth, by software (z-buffer)."""

from dataclasses import dataclass
from typing import Tuple

import numpy as np

# Of what a surface turned away from the light shows of its colour.
AMBIENT = 0.45
# Towards the light, in the world.
LIGHT = np.array([0.35, 0.2, 0.915])
SKY = (178, 204, 229)


@dataclass(frozen=True)
class Projection:
    """From a frame with x to the right, y down and z ahead, metres, to the pixels of a picture.

    A pixel's column and row are ``centre`` + ``scale`` (x, y) / z, without the division unless it is in
    ``perspective``. What is nearer than ``near`` or farther than ``far`` is not seen.
    """

    width: int
    height: int
    scale: float
    centre: Tuple[float, float]
    near: float
    far: float
    perspective: bool = True


def shade(triangles_xyz: np.ndarray, colours: np.ndarray, glows: np.ndarray) -> np.ndarray:
    """What triangles (T, 3, 3) in the world show of their ``colours`` (T, 3), 0 to 1, in the light: uint8.

    ``glows``, (T, 3), 0 to 1: what they add to that by themselves.
    """
    sides = triangles_xyz[:, 1:] - triangles_xyz[:, :1]
    normals = np.cross(sides[:, 0], sides[:, 1])
    lengths = np.linalg.norm(normals, axis=1)
    facing = np.abs(normals @ LIGHT) / np.maximum(lengths, 1e-12)
    lit = colours * (AMBIENT + (1.0 - AMBIENT) * facing)[:, None]
    return np.rint(255.0 * np.minimum(lit + glows, 1.0)).astype(np.uint8)


def rasterize(
    triangles_xyz: np.ndarray, colours: np.ndarray, projection: Projection
) -> Tuple[np.ndarray, np.ndarray]:
    """Picture (H, W, 3), uint8, and depth along z (H, W), float32, infinite where there is nothing.

    ``triangles_xyz``: (T, 3, 3) in the camera's frame; ``colours``: (T, 3), uint8.
    """
    from sim_bridge.views import kernels  # late: it brings numba

    picture = np.empty((projection.height, projection.width, 3), dtype=np.uint8)
    picture[:] = SKY
    depth = np.full((projection.height, projection.width), np.inf, dtype=np.float32)
    kernels.rasterize(
        np.ascontiguousarray(triangles_xyz, dtype=np.float64),
        np.ascontiguousarray(colours),
        projection.scale,
        *projection.centre,
        projection.near,
        projection.far,
        projection.perspective,
        picture,
        depth,
    )
    return picture, depth
