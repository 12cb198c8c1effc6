"""URDF text as links, joints and <gazebo> elements."""

from pathlib import Path
from typing import Callable, Optional, Tuple

import numpy as np

from planar.geometry.limits import MAX_COORDINATE, is_within
from sim_bridge.description.structure import GazeboElements, RobotJoint, RobotLink, RobotStructure
from sim_bridge.errors import RobotError, WorldError
from sim_bridge.geometry.meshes import load_mesh
from sim_bridge.geometry.pose3 import IDENTITY, pose3
from sim_bridge.geometry.shapes import Box, Cylinder, MeshFile, Shape, Sphere
from sim_bridge.sdf.element import Element, parse_text
from sim_bridge.sdf.warnings import SkippedElements
from sim_bridge.world import Collision

FindFile = Callable[[str], Optional[Path]]


def read_urdf(text: str, where: str, find_file: FindFile) -> Tuple[RobotStructure, GazeboElements]:
    """Read the structure of a robot from a URDF text.

    Args:
        text: The URDF.
        where: Name of the text in errors, e.g. its file.
        find_file: Finds the files of package:// and model:// URIs.

    Returns:
        The link tree, and the <gazebo> elements with warnings about missing meshes.

    Raises:
        RobotError: The description cannot be used.
    """
    robot = _parse(text, where)
    elements = GazeboElements(robot)
    reader = _UrdfReader(find_file, elements.skipped)
    try:
        links = [reader.link(link) for link in robot.children("link")]
        joints = [_joint(joint) for joint in robot.children("joint")]
        structure = RobotStructure(robot.name or where, links, joints)
        for gazebo in robot.children("gazebo"):
            elements.add(gazebo, gazebo.attribute("reference"))
    except WorldError as error:
        raise RobotError(str(error)) from None
    return structure, elements


def _parse(text: str, where: str) -> Element:
    try:
        return parse_text(text, where, ("robot",))
    except WorldError as error:
        raise RobotError(str(error)) from None


class _UrdfReader:
    """Reads links; ``skipped`` receives warnings about missing files."""

    def __init__(self, find_file: FindFile, skipped: SkippedElements):
        self._find_file, self._skipped = find_file, skipped

    def link(self, link: Element) -> RobotLink:
        collisions = []
        for collision in link.children("collision"):
            shape = self._shape(collision.required("geometry"))
            if shape is not None:
                collisions.append(Collision(shape, _origin(collision)))
        inertial = link.child("inertial")
        if inertial is None:
            return RobotLink(link.name, 0.0, np.zeros(3), np.zeros((3, 3)), tuple(collisions))
        origin = _origin(inertial)
        inertia = origin[:3, :3] @ _inertia(inertial.required("inertia")) @ origin[:3, :3].T
        (mass,) = inertial.required("mass").attribute_numbers("value", 1)
        if mass < 0.0:
            raise inertial.error(f"a mass must not be negative, got {mass:g}")
        return RobotLink(link.name, mass, origin[:3, 3], inertia, tuple(collisions))

    def _shape(self, geometry: Element) -> Optional[Shape]:
        for each in geometry.children():
            kind = geometry.required(each.tag)
            if kind.tag == "box":
                x, y, z = kind.attribute_sizes("size", 3)
                return Box((x, y, z))
            if kind.tag == "cylinder":
                return Cylinder(*kind.attribute_sizes("radius", 1), *kind.attribute_sizes("length", 1))
            if kind.tag == "sphere":
                return Sphere(*kind.attribute_sizes("radius", 1))
            if kind.tag == "mesh":
                return self._mesh(kind)
            raise kind.error("not a geometry of URDF")
        raise geometry.error("names no shape")

    def _mesh(self, mesh: Element) -> Optional[Shape]:
        name = mesh.attribute("filename")
        path = self._find_file(name)
        if path is None:
            self._skipped.skip(mesh, f"{name} not found, ignored")
            return None
        x, y, z = mesh.attribute_numbers("scale", 3, (1.0, 1.0, 1.0))
        return load_mesh(MeshFile(path, (x, y, z)))


def _joint(joint: Element) -> RobotJoint:
    return RobotJoint(
        joint.name,
        joint.required("parent").attribute("link"),
        joint.required("child").attribute("link"),
        _origin(joint),
        _axis(joint),
    )


def _axis(joint: Element) -> np.ndarray:
    """Return the axis (3,); that of a fixed joint is ignored."""
    axis = joint.child("axis")
    if axis is None or joint.attribute("type") == "fixed":
        return np.array((1.0, 0.0, 0.0))
    direction = axis.attribute_numbers("xyz", 3, (1.0, 0.0, 0.0))
    length = float(np.linalg.norm(direction))
    if length == 0.0:
        raise joint.error("an axis needs a direction, got 0 0 0")
    return np.array(direction) / length


def _origin(element: Element) -> np.ndarray:
    """Return the pose (4, 4) of an element's <origin>, by default the identity."""
    origin = element.child("origin")
    if origin is None:
        return IDENTITY
    zeros = (0.0, 0.0, 0.0)
    xyz, rpy = origin.attribute_numbers("xyz", 3, zeros), origin.attribute_numbers("rpy", 3, zeros)
    if not is_within(MAX_COORDINATE, *xyz, *rpy):
        raise origin.error(f"coordinates must be within {MAX_COORDINATE:g}, got {origin.attribute('xyz')!r}")
    return pose3(*xyz, *rpy)


def _inertia(element: Element) -> np.ndarray:
    def value(name: str) -> float:
        return element.attribute_numbers(name, 1, (0.0,))[0]

    xx, xy, xz, yy, yz, zz = (value(name) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def no_file(_name: str) -> Optional[Path]:
    """Find no file (the default of ``find_file``)."""
    return None
