"""Reads <geometry> elements."""

from pathlib import Path
from typing import Callable, Dict, List, Optional, Sequence

import numpy as np

from sim_bridge.geometry.shapes import Box, Cylinder, Mesh, MeshFile, Plane, Sphere, VisualShape
from sim_bridge.sdf.element import Element
from sim_bridge.sdf.includes import resolve
from sim_bridge.sdf.shapes.footprints import footprint_of
from sim_bridge.sdf.shapes.prism import prism

# SDF's default [m].
POLYLINE_HEIGHT = 1.0


class UnsupportedGeometryError(Exception):
    """A geometry that is not supported or missing, and can be ignored; the text is the reason."""


class MissingMeshError(UnsupportedGeometryError):
    """The file of a mesh is missing.

    Args:
        text: The reason, for the warning.
        fallback: Prisms over the mesh's footprint, if that is known.
    """

    def __init__(self, text: str, fallback: Optional[Mesh] = None):
        super().__init__(text)
        self.fallback = fallback


def read_shape(geometry: Element, folder: Path, model_folders: Sequence[Path]) -> Optional[VisualShape]:
    """Return the shape of a <geometry>, None if it is empty; a mesh is found but not loaded.

    Args:
        geometry: The element.
        folder: Folder to which relative paths of meshes refer.
        model_folders: Folders that are searched for ``model://`` URIs.

    Raises:
        UnsupportedGeometryError: The geometry is missing or not supported.
        WorldError: A value is not valid.
    """
    if geometry.child("empty") is not None:
        return None
    for tag, read in _READERS.items():
        primitive = geometry.child(tag)
        if primitive is not None:
            return read(primitive)
    mesh = geometry.child("mesh")
    if mesh is not None:
        return _find_mesh(mesh, folder, model_folders)
    polylines = list(geometry.children("polyline"))
    if polylines:
        return _extrude(polylines)
    tags = ", ".join(f"<{child.tag}>" for child in geometry.children()) or "no shape"
    raise UnsupportedGeometryError(f"{tags} is not supported")


def _read_box(box: Element) -> Box:
    x, y, z = box.required("size").sizes(3)
    return Box((x, y, z))


def _read_cylinder(cylinder: Element) -> Cylinder:
    return Cylinder(cylinder.required("radius").sizes(1)[0], cylinder.required("length").sizes(1)[0])


def _read_sphere(sphere: Element) -> Sphere:
    return Sphere(sphere.required("radius").sizes(1)[0])


def _read_plane(plane: Element) -> Plane:
    """Read an infinite plane; in Gazebo its size affects only how it is drawn."""
    normal = plane.child("normal")
    if normal is None:
        return Plane()
    x, y, z = normal.numbers(3)
    if x == y == z == 0.0:
        raise normal.error("a normal needs a direction, got 0 0 0")
    return Plane((x, y, z))


def _find_mesh(mesh: Element, folder: Path, model_folders: Sequence[Path]) -> MeshFile:
    uri = mesh.required("uri").text
    path = resolve(uri, folder, model_folders)
    scale, submesh = mesh.child("scale"), mesh.child("submesh")
    x, y, z = scale.numbers(3) if scale is not None else (1.0, 1.0, 1.0)
    if 0.0 in (x, y, z):
        raise mesh.error("a scale must not be 0")
    if path is None:
        raise MissingMeshError(f"mesh {uri} not found", footprint_of(uri, (x, y, z)))
    return MeshFile(
        path,
        (x, y, z),
        submesh.required("name").text if submesh is not None else "",
        submesh is not None and submesh.flag("center"),
    )


def _extrude(polylines: Sequence[Element]) -> Mesh:
    """Return a closed prism from z = 0 upwards over the first outline, with the others as holes."""
    rings: List[np.ndarray] = []
    for polyline in polylines:
        points_xy = np.array([point.numbers(2) for point in polyline.children("point")]).reshape(-1, 2)
        if len(points_xy) > 1 and np.array_equal(points_xy[0], points_xy[-1]):
            points_xy = points_xy[:-1]
        if len(points_xy) < 3:
            raise polyline.error(f"an outline needs 3 points or more, got {len(points_xy)}")
        rings.append(points_xy)
    height = polylines[0].child("height")
    return prism(rings, 0.0, height.lengths(1)[0] if height is not None else POLYLINE_HEIGHT)


_READERS: Dict[str, Callable[[Element], VisualShape]] = {
    "box": _read_box,
    "cylinder": _read_cylinder,
    "sphere": _read_sphere,
    "plane": _read_plane,
}
