"""Triangle meshes of solids with a size of one metre."""

from typing import Tuple

import numpy as np

CORNERS = 20

Solid = Tuple[np.ndarray, np.ndarray]


def box() -> Solid:
    """Return vertices (N, 3) and triangles (M, 3) of a cube."""
    vertices = np.array(np.meshgrid(*[(-0.5, 0.5)] * 3, indexing="ij")).reshape(3, -1).T
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [part for a, b, c, d in sides for part in ((a, b, c), (a, c, d))]
    return vertices, np.array(triangles)


def cylinder() -> Solid:
    """Return a cylinder with its axis along z."""
    rim = 0.5 * _circle()
    vertices = np.vstack([np.column_stack((rim, np.full(CORNERS, z))) for z in (-0.5, 0.5)])
    at, after = np.arange(CORNERS), np.roll(np.arange(CORNERS), -1)
    fan = np.array([(0, i, i + 1) for i in range(1, CORNERS - 1)])
    sides = [
        np.column_stack((at, after, after + CORNERS)),
        np.column_stack((at, after + CORNERS, at + CORNERS)),
    ]
    return vertices, np.vstack((fan[:, ::-1], fan + CORNERS, *sides))


def ball() -> Solid:
    """Return a sphere."""
    tilts = np.linspace(0.0, np.pi, CORNERS // 2 + 1)
    rings = [np.column_stack((_circle() * np.sin(tilt), np.full(CORNERS, np.cos(tilt)))) for tilt in tilts]
    at = np.arange((len(tilts) - 1) * CORNERS)
    after = at - at % CORNERS + (at + 1) % CORNERS
    upper = np.column_stack((at, after + CORNERS, after))
    lower = np.column_stack((at, at + CORNERS, after + CORNERS))
    return 0.5 * np.concatenate(rings), np.vstack((upper, lower))


def placed_at(vertices: np.ndarray, triangles: np.ndarray, points: np.ndarray) -> Solid:
    """Return one mesh with a copy of a solid at each point.

    Args:
        vertices: Vertices (N, 3) of the solid [m].
        triangles: Its vertex indices (M, 3).
        points: Positions (K, 3) of the copies [m].

    Returns:
        Vertices (K * N, 3) and triangles (K * M, 3).
    """
    count = len(vertices)
    copies = (vertices[None] + points[:, None]).reshape(-1, 3)
    offsets = np.arange(len(points))[:, None, None] * count
    return copies, (triangles[None] + offsets).reshape(-1, 3)


def _circle() -> np.ndarray:
    angles = np.arange(CORNERS) * (2.0 * np.pi / CORNERS)
    return np.column_stack((np.cos(angles), np.sin(angles)))
