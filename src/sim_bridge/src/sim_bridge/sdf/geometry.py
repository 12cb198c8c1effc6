"""<geometry> elements as shapes."""

from pathlib import Path
from typing import Callable, Dict, Sequence

from sim_bridge.sdf.element import Element
from sim_bridge.sdf.includes import resolve
from sim_bridge.sdf.meshes import load_mesh
from sim_bridge.shapes import Box, Cylinder, Plane, Shape, Sphere


class LeftOutError(Exception):
    """A geometry that the rest of the world can do without; the text says why."""


def read_shape(geometry: Element, folder: Path, model_folders: Sequence[Path]) -> Shape:
    """The shape of a <geometry>. Raises WorldError, or LeftOutError for what is missing or not supported."""
    kind = next((child for child in geometry.children() if child.tag in _READERS), None)
    if kind is not None:
        return _READERS[kind.tag](kind)
    mesh = geometry.child("mesh")
    if mesh is None:
        tags = ", ".join(f"<{child.tag}>" for child in geometry.children()) or "no shape"
        raise LeftOutError(f"{tags} is not supported")
    return _read_mesh(mesh, folder, model_folders)


def _read_box(box: Element) -> Box:
    x, y, z = box.required("size").lengths(3)
    return Box((x, y, z))


def _read_cylinder(cylinder: Element) -> Cylinder:
    return Cylinder(cylinder.required("radius").lengths(1)[0], cylinder.required("length").lengths(1)[0])


def _read_sphere(sphere: Element) -> Sphere:
    return Sphere(sphere.required("radius").lengths(1)[0])


def _read_plane(plane: Element) -> Plane:
    """A plane without end: what Gazebo limits is only its looks."""
    normal = plane.child("normal")
    if normal is None:
        return Plane()
    x, y, z = normal.numbers(3)
    if x == y == z == 0.0:
        raise normal.error("a normal needs a direction, got 0 0 0")
    return Plane((x, y, z))


def _read_mesh(mesh: Element, folder: Path, model_folders: Sequence[Path]) -> Shape:
    uri = mesh.required("uri").text
    path = resolve(uri, folder, model_folders)
    if path is None:
        raise LeftOutError(f"mesh {uri} not found")
    scale, submesh = mesh.child("scale"), mesh.child("submesh")
    return load_mesh(
        path,
        scale=scale.numbers(3) if scale is not None else (1.0, 1.0, 1.0),
        submesh=submesh.required("name").text if submesh is not None else "",
        centred=submesh is not None and submesh.flag("center"),
    )


_READERS: Dict[str, Callable[[Element], Shape]] = {
    "box": _read_box,
    "cylinder": _read_cylinder,
    "sphere": _read_sphere,
    "plane": _read_plane,
}
