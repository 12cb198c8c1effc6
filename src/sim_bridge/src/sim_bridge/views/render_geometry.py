"""What can be seen of the bodies of a world, as triangles with colours."""

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
# Half the width of what is drawn of an endless plane, metres, and its number of tiles along it.
PLANE_REACH, PLANE_TILES = 60.0, 12
CIRCLE_CORNERS = 24

# Triangles (T, 3, 3) in a body's own frame, their colours and what they glow of themselves (T, 3), 0 to 1.
_Looks = Tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True, eq=False)
class _Drawn:
    """A body's looks, and its triangles (T, 3, 3) in the world with the body ``at`` (4, 4)."""

    looks: _Looks
    at: np.ndarray
    triangles: np.ndarray
    colours: np.ndarray


class RenderGeometry:
    """The triangles of all bodies, where those that move are. A body without visuals shows its solids."""

    def __init__(self):
        self._still: Dict[str, _Drawn] = {}
        self._moving: Dict[str, _Drawn] = {}
        self._all_still: Optional[Tuple[np.ndarray, np.ndarray]] = None
        # In words, what cannot be drawn.
        self.warnings: List[str] = []

    def add(self, body: Body) -> None:
        parts = []
        for visual in visible_parts(body):
            try:
                parts.append(_looks_of(visual))
            except WorldError as error:
                self.warnings.append(f"not to be seen: {error}")
        triangles = np.concatenate([np.empty((0, 3, 3)), *(triangles for triangles, _, _ in parts)])
        colours = np.concatenate([np.empty((0, 3)), *(colours for _, colours, _ in parts)])
        glows = np.concatenate([np.empty((0, 3)), *(glows for _, _, glows in parts)])
        self._place(body.name, body.is_static, (triangles, colours, glows), body.pose_in_world)

    def move(self, name: str, pose: np.ndarray) -> None:
        """A body that otherwise keeps still has been put to another place."""
        if name in self._still:
            drawn = self._still[name]
            self._place(name, True, drawn.looks, pose)

    def remove(self, name: str) -> None:
        self._moving.pop(name, None)
        if self._still.pop(name, None) is not None:
            self._all_still = None

    def triangles(self, pose_of: Callable[[str], np.ndarray], but: str = "") -> Tuple[np.ndarray, np.ndarray]:
        """Triangles (T, 3, 3) in the world and their shades (T, 3), uint8, but for those of a model."""
        if self._all_still is None:
            still = self._still.values()
            self._all_still = (
                np.concatenate([np.empty((0, 3, 3)), *(drawn.triangles for drawn in still)]),
                np.concatenate([np.empty((0, 3), np.uint8), *(drawn.colours for drawn in still)]),
            )
        for name, drawn in list(self._moving.items()):
            pose = pose_of(name)
            if not np.array_equal(pose, drawn.at):
                self._place(name, False, drawn.looks, pose)
        seen = [drawn for name, drawn in self._moving.items() if name.split("::", 1)[0] != but]
        return (
            np.concatenate([self._all_still[0], *(drawn.triangles for drawn in seen)]),
            np.concatenate([self._all_still[1], *(drawn.colours for drawn in seen)]),
        )

    def _place(self, name: str, still: bool, looks: _Looks, pose) -> None:
        in_body, own_colours, glows = looks
        triangles = transform_points(pose, in_body.reshape(-1, 3)).reshape(-1, 3, 3)
        drawn = _Drawn(looks, pose, triangles, shade(triangles, own_colours, glows))
        if still:
            self._still[name] = drawn
            self._all_still = None
        else:
            self._moving[name] = drawn


def visible_parts(body: Body) -> Sequence[Visual]:
    """What there is to see of a body: its solids if it has no visuals."""
    return body.visuals or [Visual(part.shape, part.pose_in_body) for part in body.collisions]


def _looks_of(visual: Visual) -> _Looks:
    mesh = mesh_of(visual.shape)
    triangles = transform_points(visual.pose_in_body, mesh.vertices)[mesh.triangles]
    count = len(triangles)
    if visual.colour is None and mesh.colours is not None:
        return triangles, mesh.colours, np.zeros((count, 3))
    return triangles, np.tile(visual.colour or GREY, (count, 1)), np.tile(visual.emissive, (count, 1))


def mesh_of(shape: VisualShape) -> Mesh:
    """Any shape as triangles; of an endless plane a large square."""
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
        return _ball(shape.radius)
    return _square(shape)


def _circle() -> np.ndarray:
    angles = np.arange(CIRCLE_CORNERS) * (2.0 * math.pi / CIRCLE_CORNERS)
    return np.column_stack((np.cos(angles), np.sin(angles)))


def _prism(outline_xy: np.ndarray, height: float) -> Mesh:
    """Over a convex outline (N, 2) in order, half above z = 0 and half below."""
    count = len(outline_xy)
    vertices = np.vstack(
        [np.column_stack((outline_xy, np.full(count, z))) for z in (-height / 2.0, height / 2.0)]
    )
    at, after = np.arange(count), np.roll(np.arange(count), -1)
    lid = np.array([(0, i, i + 1) for i in range(1, count - 1)])
    sides = [np.column_stack((at, after, after + count)), np.column_stack((at, after + count, at + count))]
    return Mesh(vertices, np.vstack((lid, lid + count, *sides)))


def _ball(radius: float) -> Mesh:
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


def _square(plane: Plane) -> Mesh:
    normal = np.asarray(plane.normal) / np.linalg.norm(plane.normal)
    along = np.cross(normal, (1.0, 0.0, 0.0) if abs(normal[0]) < 0.9 else (0.0, 1.0, 0.0))
    along /= np.linalg.norm(along)
    across = np.cross(normal, along)
    ticks = np.linspace(-PLANE_REACH, PLANE_REACH, PLANE_TILES + 1)
    vertices = (ticks[:, None, None] * along + ticks[None, :, None] * across).reshape(-1, 3)
    corner = (np.arange(PLANE_TILES)[:, None] * (PLANE_TILES + 1) + np.arange(PLANE_TILES)).ravel()
    right, up = corner + PLANE_TILES + 1, corner + 1
    return Mesh(
        vertices,
        np.vstack((np.column_stack((corner, right, right + 1)), np.column_stack((corner, right + 1, up)))),
    )
