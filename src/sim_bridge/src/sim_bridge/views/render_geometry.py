"""Triangles and colours of bodies, for cameras and images."""

import math
from dataclasses import dataclass
from typing import Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np

from sim_bridge.errors import WorldError
from sim_bridge.geometry.meshes import load_mesh
from sim_bridge.geometry.pose3 import transform_points
from sim_bridge.geometry.shapes import Box, Cylinder, Mesh, MeshFile, Plane, Sphere, VisualShape
from sim_bridge.views.rasterizer import shade
from sim_bridge.world import Body, Colour, Visual

GREY: Colour = (0.7, 0.7, 0.7)
# Half the width of the square drawn for an infinite plane [m], and its number of tiles along a side.
PLANE_EXTENT, PLANE_TILES = 60.0, 12
CIRCLE_CORNERS = 24

# Triangles (T, 3, 3) in the body frame, their colours and emissive colours (T, 3), 0 to 1.
_Appearance = Tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True, eq=False)
class _RenderedBody:
    """Appearance of a body, and its triangles (T, 3, 3) in the world for the pose ``pose`` (4, 4)."""

    appearance: _Appearance
    pose: np.ndarray
    triangles: np.ndarray
    colours: np.ndarray


class RenderGeometry:
    """The triangles of all bodies at their present poses. A body without visuals shows its collisions."""

    def __init__(self):
        self._static: Dict[str, _RenderedBody] = {}
        self._moving: Dict[str, _RenderedBody] = {}
        self._all_static: Optional[Tuple[np.ndarray, np.ndarray]] = None
        # One text for each visual that cannot be rendered.
        self.warnings: List[str] = []

    def add(self, body: Body) -> None:
        """Add a body."""
        parts = []
        for visual in visible_parts(body):
            try:
                parts.append(_appearance_of(visual))
            except WorldError as error:
                self.warnings.append(f"not rendered: {error}")
        triangles = np.concatenate([np.empty((0, 3, 3)), *(triangles for triangles, _, _ in parts)])
        colours = np.concatenate([np.empty((0, 3)), *(colours for _, colours, _ in parts)])
        emissive = np.concatenate([np.empty((0, 3)), *(emissive for _, _, emissive in parts)])
        self._place(body.name, body.is_static, (triangles, colours, emissive), body.pose_in_world)

    def move(self, name: str, pose: np.ndarray) -> None:
        """Move a static body; the poses of others are read each time.

        Args:
            name: Name of the body; others than static ones are ignored.
            pose: Pose (4, 4) in the world.
        """
        if name in self._static:
            drawn = self._static[name]
            self._place(name, True, drawn.appearance, pose)

    def remove(self, name: str) -> None:
        """Remove a body."""
        self._moving.pop(name, None)
        if self._static.pop(name, None) is not None:
            self._all_static = None

    def triangles(
        self, pose_of: Callable[[str], np.ndarray], excluded_model: str = ""
    ) -> Tuple[np.ndarray, np.ndarray]:
        """Return the triangles of all bodies at their present poses.

        Args:
            pose_of: Returns the present pose (4, 4) of a body.
            excluded_model: Model whose bodies are left out.

        Returns:
            Triangles (T, 3, 3) in the world [m], and their shaded colours (T, 3), uint8.
        """
        if self._all_static is None:
            static = self._static.values()
            self._all_static = (
                np.concatenate([np.empty((0, 3, 3)), *(drawn.triangles for drawn in static)]),
                np.concatenate([np.empty((0, 3), np.uint8), *(drawn.colours for drawn in static)]),
            )
        for name, drawn in list(self._moving.items()):
            pose = pose_of(name)
            if not np.array_equal(pose, drawn.pose):
                self._place(name, False, drawn.appearance, pose)
        visible = [drawn for name, drawn in self._moving.items() if name.split("::", 1)[0] != excluded_model]
        return (
            np.concatenate([self._all_static[0], *(drawn.triangles for drawn in visible)]),
            np.concatenate([self._all_static[1], *(drawn.colours for drawn in visible)]),
        )

    def _place(self, name: str, is_static: bool, appearance: _Appearance, pose) -> None:
        in_body, own_colours, emissive = appearance
        triangles = transform_points(pose, in_body.reshape(-1, 3)).reshape(-1, 3, 3)
        drawn = _RenderedBody(appearance, pose, triangles, shade(triangles, own_colours, emissive))
        if is_static:
            self._static[name] = drawn
            self._all_static = None
        else:
            self._moving[name] = drawn


def visible_parts(body: Body) -> Sequence[Visual]:
    """Return the visuals of a body, made from its collisions if it has none."""
    return body.visuals or [Visual(part.shape, part.pose_in_body) for part in body.collisions]


def _appearance_of(visual: Visual) -> _Appearance:
    mesh = mesh_of(visual.shape)
    triangles = transform_points(visual.pose_in_body, mesh.vertices)[mesh.triangles]
    count = len(triangles)
    if visual.colour is None and mesh.colours is not None:
        return triangles, mesh.colours, np.zeros((count, 3))
    return triangles, np.tile(visual.colour or GREY, (count, 1)), np.tile(visual.emissive, (count, 1))


def mesh_of(shape: VisualShape) -> Mesh:
    """Return the triangles of a shape; a large square for an infinite plane."""
    if isinstance(shape, Mesh):
        return shape
    if isinstance(shape, MeshFile):
        return load_mesh(shape)
    if isinstance(shape, Box):
        return _prism(
            np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]) * shape.size[:2], shape.size[2]
        )
    if isinstance(shape, Cylinder):
        return _prism(_circle() * shape.radius, shape.length)
    if isinstance(shape, Sphere):
        return _sphere(shape.radius)
    return _plane(shape)


def _circle() -> np.ndarray:
    angles = np.arange(CIRCLE_CORNERS) * (2.0 * math.pi / CIRCLE_CORNERS)
    return np.column_stack((np.cos(angles), np.sin(angles)))


def _prism(outline_xy: np.ndarray, height: float) -> Mesh:
    """Return a prism over a convex outline (N, 2), centred at z = 0."""
    count = len(outline_xy)
    vertices = np.vstack(
        [np.column_stack((outline_xy, np.full(count, z))) for z in (-height / 2.0, height / 2.0)]
    )
    at, after = np.arange(count), np.roll(np.arange(count), -1)
    lid = np.array([(0, i, i + 1) for i in range(1, count - 1)])
    sides = [np.column_stack((at, after, after + count)), np.column_stack((at, after + count, at + count))]
    return Mesh(vertices, np.vstack((lid, lid + count, *sides)))


def _sphere(radius: float) -> Mesh:
    rings = CIRCLE_CORNERS // 2
    tilts = np.arange(rings + 1) * (math.pi / rings)
    vertices = np.concatenate(
        [
            np.column_stack((_circle() * math.sin(tilt), np.full(CIRCLE_CORNERS, math.cos(tilt))))
            for tilt in tilts
        ]
    )
    at = np.arange(rings * CIRCLE_CORNERS)
    after = at - at % CIRCLE_CORNERS + (at + 1) % CIRCLE_CORNERS
    upper = np.column_stack((at, after, after + CIRCLE_CORNERS))
    lower = np.column_stack((at, after + CIRCLE_CORNERS, at + CIRCLE_CORNERS))
    return Mesh(vertices * radius, np.vstack((upper, lower)))


def _plane(plane: Plane) -> Mesh:
    normal = np.asarray(plane.normal) / np.linalg.norm(plane.normal)
    along = np.cross(normal, (1.0, 0.0, 0.0) if abs(normal[0]) < 0.9 else (0.0, 1.0, 0.0))
    along /= np.linalg.norm(along)
    across = np.cross(normal, along)
    ticks = np.linspace(-PLANE_EXTENT, PLANE_EXTENT, PLANE_TILES + 1)
    vertices = (ticks[:, None, None] * along + ticks[None, :, None] * across).reshape(-1, 3)
    corner = (np.arange(PLANE_TILES)[:, None] * (PLANE_TILES + 1) + np.arange(PLANE_TILES)).ravel()
    right, up = corner + PLANE_TILES + 1, corner + 1
    return Mesh(
        vertices,
        np.vstack((np.column_stack((corner, right, right + 1)), np.column_stack((corner, right + 1, up)))),
    )
