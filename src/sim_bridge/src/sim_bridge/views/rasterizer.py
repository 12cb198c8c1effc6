"""Software rasterization of triangles into colour and depth images (z-buffer)."""

from dataclasses import dataclass
from typing import Tuple

import numpy as np

# Fraction of its colour that a surface facing away from the light shows.
AMBIENT = 0.45
# Direction towards the light, in the world.
LIGHT = np.array([0.35, 0.2, 0.915])
SKY = (178, 204, 229)


@dataclass(frozen=True)
class Projection:
    """Projection from the optical frame (x right, y down, z forward) to pixels.

    Attributes:
        width: Width of the image [pixels].
        height: Height of the image [pixels].
        scale: Pixels per metre, at 1 m distance if ``perspective``.
        centre: Column and row of the optical axis.
        near: Nearest visible depth [m].
        far: Farthest visible depth [m].
        perspective: Whether x and y are divided by z.
    """

    width: int
    height: int
    scale: float
    centre: Tuple[float, float]
    near: float
    far: float
    perspective: bool = True


def shade(triangles_xyz: np.ndarray, colours: np.ndarray, emissive: np.ndarray) -> np.ndarray:
    """Return the shaded colours of triangles.

    Args:
        triangles_xyz: Triangles (T, 3, 3) in the world [m].
        colours: Diffuse colours (T, 3), 0 to 1.
        emissive: Emissive colours (T, 3), 0 to 1.

    Returns:
        Colours (T, 3), uint8.
    """
    sides = triangles_xyz[:, 1:] - triangles_xyz[:, :1]
    normals = np.cross(sides[:, 0], sides[:, 1])
    lengths = np.linalg.norm(normals, axis=1)
    facing = np.abs(normals @ LIGHT) / np.maximum(lengths, 1e-12)
    lit = colours * (AMBIENT + (1.0 - AMBIENT) * facing)[:, None]
    return np.rint(255.0 * np.minimum(lit + emissive, 1.0)).astype(np.uint8)


def rasterize(
    triangles_xyz: np.ndarray, colours: np.ndarray, projection: Projection
) -> Tuple[np.ndarray, np.ndarray]:
    """Render triangles.

    Args:
        triangles_xyz: Triangles (T, 3, 3) in the optical frame [m].
        colours: Their colours (T, 3), uint8.
        projection: The camera.

    Returns:
        The image (H, W, 3), uint8, and the depth along z (H, W) [m], float32, infinite where nothing is.
    """
    from sim_bridge.views import kernels  # late: it brings numba

    image = np.empty((projection.height, projection.width, 3), dtype=np.uint8)
    image[:] = SKY
    depth = np.full((projection.height, projection.width), np.inf, dtype=np.float32)
    kernels.rasterize(
        np.ascontiguousarray(triangles_xyz, dtype=np.float64),
        np.ascontiguousarray(colours),
        projection.scale,
        *projection.centre,
        projection.near,
        projection.far,
        projection.perspective,
        image,
        depth,
    )
    return image, depth
