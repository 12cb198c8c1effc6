"""Images of a world from above."""

from typing import Callable, Tuple

import numpy as np

from sim_bridge.errors import WorldError
from sim_bridge.geometry.shapes import Plane
from sim_bridge.views.rasterizer import Projection, rasterize
from sim_bridge.views.render_geometry import RenderGeometry, visible_parts
from sim_bridge.views.true_map import outlines_of
from sim_bridge.world import World

# Length of the longer side [pixels], and margin around the bodies [m].
SIZE, MARGIN = 1200, 0.5
CUT_GREY = 70


def render_top_view(
    world: World, below: float = 2.0, size: int = SIZE, warn: Callable[[str], None] = lambda text: None
) -> np.ndarray:
    """Render a world from above, in orthographic projection with y upwards.

    Args:
        world: The world.
        below: Height above which everything is cut off [m]; cut surfaces are dark grey.
        size: Length of the longer side [pixels].
        warn: Called with a text for each visual that cannot be rendered.

    Returns:
        The image (H, W, 3), uint8.

    Raises:
        WorldError: The world holds only infinite planes.
    """
    low, high = _extent(world)
    scale = (size - 1) / float((high - low).max())
    width, height = (int(round(float(length) * scale)) + 1 for length in high - low)
    triangles, shades = _triangles(world, planes=True, warn=warn)
    caps = _caps(world, below)
    triangles = np.concatenate((triangles, caps))
    shades = np.concatenate((shades, np.full((len(caps), 3), CUT_GREY, dtype=np.uint8)))
    projection = Projection(
        width, height, scale, (-low[0] * scale, high[1] * scale), near=-1e-6, far=np.inf, perspective=False
    )
    image, _ = rasterize(triangles * (1.0, -1.0, -1.0) + (0.0, 0.0, below), shades, projection)
    return image


def _extent(world: World) -> Tuple[np.ndarray, np.ndarray]:
    """Return the lower left and upper right corners (2,) of all bodies except infinite planes."""
    triangles, _ = _triangles(world, planes=False)
    if not len(triangles):
        raise WorldError(f"world '{world.name}': it has nothing to render")
    points_xy = triangles[..., :2].reshape(-1, 2)
    return points_xy.min(axis=0) - MARGIN, points_xy.max(axis=0) + MARGIN


def _caps(world: World, height: float) -> np.ndarray:
    """Return triangles (T, 3, 3) that close the solids cut at a height [m]."""
    fans = [
        np.stack((np.repeat(outline[:1], len(outline) - 2, axis=0), outline[1:-1], outline[2:]), axis=1)
        for outline in outlines_of(world, height, height)
        if len(outline) > 2
    ]
    flat = np.concatenate([np.empty((0, 3, 2)), *fans])
    return np.concatenate((flat, np.full((*flat.shape[:2], 1), height)), axis=2)


def _triangles(
    world: World, planes: bool, warn: Callable[[str], None] = lambda text: None
) -> Tuple[np.ndarray, np.ndarray]:
    poses = {body.name: body.pose_in_world for body in world.bodies}
    geometry = RenderGeometry()
    for body in world.bodies:
        if planes or not any(isinstance(part.shape, Plane) for part in visible_parts(body)):
            geometry.add(body)
    for warning in geometry.warnings:
        warn(warning)
    return geometry.triangles(poses.__getitem__)
