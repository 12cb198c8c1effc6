"""Read the visual shapes of worlds and robots from SDF and URDF.

This module loads the physics packages. cockpit.ros.world.scene_reader runs it in a child process, so that
they do not stay in the cockpit's memory and a malformed mesh cannot crash the cockpit.
"""

import math
from pathlib import Path
from typing import Dict, Iterator, List, Optional, Sequence, Tuple
from zipfile import BadZipFile

import numpy as np

from cockpit.drawing import Colour
from cockpit.errors import CockpitError
from cockpit.scene.description import DESCRIPTION_SUFFIX, DisplayJoint, SceneDescription, VisualPart
from planar import PlanarError
from planar.files.reading import read_bytes
from sim_bridge import load_world
from sim_bridge.description import read_prop
from sim_bridge.description.urdf import FindFile
from sim_bridge.geometry.pose3 import IDENTITY, pose3, transform_points
from sim_bridge.geometry.shapes import Box, Cylinder, MeshFile, Plane, Sphere
from sim_bridge.geometry.shapes import VisualShape as Shape
from sim_bridge.sdf import read_model
from sim_bridge.sdf.element import Element, parse_text
from sim_bridge.views.render_geometry import GREY, mesh_of, visible_parts
from sim_bridge.world import Joint, World

# Triangle colours that differ by less (of 255) are merged: each colour is a separate mesh.
COARSENESS = 16
# Open position of joints without limits [rad, m]; a larger limit than BEYOND counts as none.
FREELY, BEYOND = {"revolute": math.pi / 2.0, "prismatic": 0.5}, 1000.0


def describe_world(path: Path, folders: Sequence[Path]) -> SceneDescription:
    """Describe the bodies of an SDF file, or read their description.

    Args:
        path: The file; with DESCRIPTION_SUFFIX it holds the bytes of a description.
        folders: Folders that are searched for ``model://`` URIs.

    Raises:
        PlanarError: The file cannot be used.
    """
    if path.suffix == DESCRIPTION_SUFFIX:
        return _read_description(path)
    return describe_bodies(load_world(path, folders))


def _read_description(path: Path) -> SceneDescription:
    try:
        return SceneDescription.from_bytes(read_bytes(path))
    except (OSError, ValueError, LookupError, BadZipFile) as error:
        raise CockpitError(f"{path}: no description of a world ({error})") from None


def describe_model(text: str, name: str, folders: Sequence[Path], find_file: FindFile) -> SceneDescription:
    """Describe one model at the origin.

    Args:
        text: SDF or URDF of the model.
        name: Name of the model.
        folders: Folders that are searched for ``model://`` URIs.
        find_file: Finds the files of package:// and model:// URIs in a URDF.

    Raises:
        PlanarError: The text cannot be used.
    """
    if parse_text(text, name, ("sdf", "gazebo", "robot")).tag == "robot":
        return describe_bodies(read_prop(text, name, IDENTITY, find_file))
    return describe_bodies(read_model(text, name, IDENTITY, folders))


def describe_bodies(world: World) -> SceneDescription:
    """Describe the bodies of a loaded world."""
    collector = _Collector()
    for body in world.bodies:
        model, _, link = body.name.partition("::")
        for visual in visible_parts(body):
            if not isinstance(visual.shape, Plane):  # the page draws its own floor
                place = model, link, body.pose_in_world, body.mass is not None
                collector.add(place, visual.shape, visual.pose_in_body, visual.colour)
    joints = tuple(_display_joint(joint) for joint in world.joints if joint.kind in FREELY)
    return SceneDescription(tuple(collector.parts), (*world.warnings, *collector.warnings), joints)


def describe_robot(text: str, find_file: FindFile) -> SceneDescription:
    """Describe the links of a robot's URDF, each in its link frame.

    Args:
        text: The URDF.
        find_file: Finds the files of package:// and model:// URIs.

    Raises:
        PlanarError: The text cannot be used.
    """
    robot = parse_text(text, "robot_description", ("robot",))
    named = {child.name: _rgb(child) for child in robot.children("material")}
    collector = _Collector()
    for link in robot.children("link"):
        for visual in link.children("visual"):
            shape = _shape(visual.required("geometry"), find_file)
            if shape is None:
                collector.warnings.append(f"{link.name}: its mesh was not found")
                continue
            material = visual.child("material")
            own = None if material is None else _rgb(material) or named.get(material.name)
            collector.add(("", link.name, IDENTITY, True), shape, _origin(visual), own)
    return SceneDescription(tuple(collector.parts), tuple(collector.warnings))


def robot_joints(text: str) -> Dict[str, Tuple[str, np.ndarray]]:
    """Return how the links of a URDF are connected.

    Returns:
        Parent link, and pose (4, 4) in it with the joint at 0, by child link.
    """
    robot = parse_text(text, "robot_description", ("robot",))
    return {
        joint.required("child").attribute("link"): (
            joint.required("parent").attribute("link"),
            _origin(joint),
        )
        for joint in robot.children("joint")
    }


def _display_joint(joint: Joint) -> DisplayJoint:
    """Return a joint whose closed position is the limit closer to zero, the position in the file."""
    shut, wide = sorted((joint.lower, joint.upper), key=abs)
    if abs(wide) > BEYOND:
        shut, wide = 0.0, FREELY[joint.kind]
    return DisplayJoint(joint.model, joint.name.partition("::")[2], shut, wide)


class _Collector:
    """Collects the triangles of shapes, grouped by colour."""

    def __init__(self):
        self.parts: List[VisualPart] = []
        self.warnings: List[str] = []

    def add(self, place: Tuple[str, str, np.ndarray, bool], shape: Shape, pose: np.ndarray, rgb) -> None:
        """Add the triangles of a shape.

        Args:
            place: Model, link, pose (4, 4) of the link in the world, and whether the link moves.
            shape: The shape.
            pose: Pose (4, 4) of the shape in the link frame.
            rgb: Red, green, blue, 0 to 1; None for the colours of the mesh.
        """
        model, link, link_pose, moves = place
        try:
            for vertices, triangles, colour in _coloured(shape, rgb):
                vertices = transform_points(pose, vertices)
                self.parts.append(VisualPart(model, link, link_pose, vertices, triangles, colour, moves))
        except PlanarError as error:
            self.warnings.append(str(error))


def _coloured(shape: Shape, rgb) -> Iterator[Tuple[np.ndarray, np.ndarray, Colour]]:
    """Yield vertices and triangles of a shape, once for each colour."""
    mesh = mesh_of(shape)
    if rgb is not None or mesh.colours is None:
        yield mesh.vertices, mesh.triangles, _colour(rgb or GREY)
        return
    coarse = np.round(mesh.colours * 255.0 / COARSENESS) * COARSENESS / 255.0
    for colour, members in _grouped(coarse):
        used, triangles = np.unique(mesh.triangles[members], return_inverse=True)
        yield mesh.vertices[used], triangles.reshape(-1, 3), _colour(tuple(colour))


def _grouped(rows: np.ndarray) -> Iterator[Tuple[np.ndarray, np.ndarray]]:
    """Yield each distinct row, and the indices at which it is."""
    different, which = np.unique(rows, axis=0, return_inverse=True)
    for number, row in enumerate(different):
        yield row, np.flatnonzero(which.reshape(-1) == number)


def _colour(rgb: Sequence[float]) -> Colour:
    red, green, blue = (int(round(255.0 * min(max(float(part), 0.0), 1.0))) for part in rgb)
    return red, green, blue


def _rgb(material: Element) -> Optional[Tuple[float, ...]]:
    colour = material.child("color")
    return None if colour is None else tuple(colour.attribute_numbers("rgba", 4)[:3])


def _origin(element: Element) -> np.ndarray:
    origin, zeros = element.child("origin"), (0.0, 0.0, 0.0)
    if origin is None:
        return IDENTITY
    return pose3(*origin.attribute_numbers("xyz", 3, zeros), *origin.attribute_numbers("rpy", 3, zeros))


def _shape(geometry: Element, find_file: FindFile) -> Optional[Shape]:
    """Return a shape; None for a mesh that is missing or a geometry that is not supported."""
    sizes: Dict[str, Element] = {kind.tag: kind for kind in geometry.children()}
    if "box" in sizes:
        x, y, z = sizes["box"].attribute_sizes("size", 3)
        return Box((x, y, z))
    if "cylinder" in sizes:
        (radius,), (length,) = (sizes["cylinder"].attribute_sizes(name, 1) for name in ("radius", "length"))
        return Cylinder(radius, length)
    if "sphere" in sizes:
        return Sphere(*sizes["sphere"].attribute_sizes("radius", 1))
    if "mesh" in sizes:
        path = find_file(sizes["mesh"].attribute("filename"))
        scale = sizes["mesh"].attribute_numbers("scale", 3, (1.0, 1.0, 1.0))
        return None if path is None else MeshFile(path, (scale[0], scale[1], scale[2]))
    return None
