"""Prisms over outlines."""

from typing import Sequence

import mapbox_earcut
import numpy as np

from sim_bridge.geometry.shapes import Mesh


def prism(rings: Sequence[np.ndarray], bottom: float, top: float) -> Mesh:
    """Return a closed vertical prism, whose lids are triangulated by ear clipping.

    Args:
        rings: Corners (N, 2), in order [m]: of the outline first, then of each hole.
        bottom: Height of the lower lid [m].
        top: Height of the upper lid [m].
    """
    points_xy, ends = np.vstack(rings), np.cumsum([len(ring) for ring in rings])
    lid = mapbox_earcut.triangulate_float64(points_xy, ends.astype(np.uint32)).reshape(-1, 3).astype(np.int64)
    count = len(points_xy)
    lower = np.arange(count)
    following = np.concatenate(
        [np.roll(np.arange(end - len(ring), end), -1) for ring, end in zip(rings, ends)]
    )
    sides = np.vstack(
        (
            np.column_stack((lower, following, following + count)),
            np.column_stack((lower, following + count, lower + count)),
        )
    )
    vertices = np.vstack([np.column_stack((points_xy, np.full(count, z))) for z in (bottom, top)])
    return Mesh(vertices, np.vstack((lid, lid + count, sides)))
