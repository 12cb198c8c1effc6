"""Triangles drawn into pictures of colour and depth, by software (z-buffer)."""

from dataclasses import dataclass
from typing import Tuple

import numba
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


def shades(triangles_xyz: np.ndarray, colours: np.ndarray) -> np.ndarray:
    """What triangles (T, 3, 3) in the world show of their ``colours`` (T, 3), 0 to 1, in the light: uint8."""
    sides = triangles_xyz[:, 1:] - triangles_xyz[:, :1]
    normals = np.cross(sides[:, 0], sides[:, 1])
    lengths = np.linalg.norm(normals, axis=1)
    facing = np.abs(normals @ LIGHT) / np.maximum(lengths, 1e-12)
    return np.rint(255.0 * colours * (AMBIENT + (1.0 - AMBIENT) * facing)[:, None]).astype(np.uint8)


def draw(
    triangles_xyz: np.ndarray, colours: np.ndarray, projection: Projection
) -> Tuple[np.ndarray, np.ndarray]:
    """Picture (H, W, 3), uint8, and depth along z (H, W), float32, infinite where there is nothing.

    ``triangles_xyz``: (T, 3, 3) in the camera's frame; ``colours``: (T, 3), uint8.
    """
    picture = np.empty((projection.height, projection.width, 3), dtype=np.uint8)
    picture[:] = SKY
    depth = np.full((projection.height, projection.width), np.inf, dtype=np.float32)
    _draw(
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


@numba.njit(cache=True)
def _draw(triangles, colours, scale, centre_x, centre_y, near, far, perspective, picture, depth):
    """Cuts each triangle off at the near plane and fills what is left of it, as a fan."""
    corners = np.empty((4, 3))
    for t in range(triangles.shape[0]):
        count = 0
        for i in range(3):
            a, b = triangles[t, i], triangles[t, (i + 1) % 3]
            if a[2] >= near:
                corners[count] = a
                count += 1
            if (a[2] >= near) != (b[2] >= near):
                share = (near - a[2]) / (b[2] - a[2])
                corners[count] = a + share * (b - a)
                count += 1
        if count < 3:
            continue
        for i in range(count):
            factor = scale / corners[i, 2] if perspective else scale
            corners[i, 0] = corners[i, 0] * factor + centre_x
            corners[i, 1] = corners[i, 1] * factor + centre_y
            if perspective:
                corners[i, 2] = 1.0 / corners[i, 2]
        for i in range(1, count - 1):
            _fill(corners[0], corners[i], corners[i + 1], colours[t], far, perspective, picture, depth)


@numba.njit(cache=True)
def _fill(a, b, c, colour, far, perspective, picture, depth):
    """Pixels whose centre lies in a triangle; 1 / z (or z, without perspective) is linear in the picture."""
    height, width = depth.shape
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    if area == 0.0:
        return
    top = max(int(np.ceil(min(a[1], b[1], c[1]))), 0)
    bottom = min(int(np.floor(max(a[1], b[1], c[1]))), height - 1)
    left = max(int(np.ceil(min(a[0], b[0], c[0]))), 0)
    right = min(int(np.floor(max(a[0], b[0], c[0]))), width - 1)
    for row in range(top, bottom + 1):
        for col in range(left, right + 1):
            of_a = ((b[0] - col) * (c[1] - row) - (b[1] - row) * (c[0] - col)) / area
            of_b = ((c[0] - col) * (a[1] - row) - (c[1] - row) * (a[0] - col)) / area
            of_c = 1.0 - of_a - of_b
            if of_a < 0.0 or of_b < 0.0 or of_c < 0.0:
                continue
            value = of_a * a[2] + of_b * b[2] + of_c * c[2]
            z = 1.0 / value if perspective else value
            if z < depth[row, col] and z <= far:
                depth[row, col] = z
                picture[row, col, 0] = colour[0]
                picture[row, col, 1] = colour[1]
                picture[row, col, 2] = colour[2]
