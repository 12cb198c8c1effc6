"""A robot's URDF as the few rigid parts that physics needs: a base with what is fixed to it, and wheels."""

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Sequence, Tuple

import defusedxml.ElementTree
import numpy as np
from defusedxml.common import DefusedXmlException

from sim_bridge.errors import RobotError
from sim_bridge.pose3 import IDENTITY, pose3
from sim_bridge.shapes import Box, Cylinder, Shape, Sphere
from sim_bridge.world import Body, Collision, World


@dataclass(frozen=True, eq=False)
class Part:
    """A rigid part of a robot; ``name``: of its link, or of the first of those that are fixed to each other.

    ``mass`` in kg, ``centre_of_mass`` (3,) in the part's frame, ``inertia`` (3,) about it along the axes of
    that frame, kg m^2.
    """

    name: str
    mass: float
    centre_of_mass: np.ndarray
    inertia: np.ndarray
    collisions: Tuple[Collision, ...]


@dataclass(frozen=True, eq=False)
class Wheel:
    """A part that turns about ``axis`` (3,), mounted at ``origin_in_base`` (4, 4); ``effort`` in N m."""

    part: Part
    origin_in_base: np.ndarray
    axis: np.ndarray
    effort: float


@dataclass(frozen=True, eq=False)
class RobotModel:
    """The base in its root frame, and the wheels by the names of their joints."""

    base: Part
    wheels: Dict[str, Wheel]


def read_robot(description: str) -> RobotModel:
    """The rigid parts of a URDF text. Raises RobotError."""
    root = _parse(description)
    links = {link.get("name"): link for link in root.iter("link")}
    joints = list(root.iter("joint"))
    children = {_link_of(joint, "child") for joint in joints}
    roots = [name for name in links if name not in children]
    if len(roots) != 1:
        raise RobotError(
            f"robot {root.get('name')}: expected one root link, got {', '.join(map(str, roots)) or 'none'}"
        )
    fixed, wheels = [(links[roots[0]], IDENTITY)], {}
    at = 0
    while at < len(fixed):
        link, link_in_base = fixed[at]
        at += 1
        for joint in joints:
            if _link_of(joint, "parent") != link.get("name"):
                continue
            child, child_in_base = links[_link_of(joint, "child")], link_in_base @ origin_of(joint)
            if joint.get("type") == "fixed":
                fixed.append((child, child_in_base))
            else:
                wheels[joint.get("name", "")] = _wheel(joint, child, child_in_base)
    return RobotModel(_merged(fixed), wheels)


def read_prop(description: str, name: str, pose: np.ndarray, model_folders: Sequence[Path] = ()) -> World:
    """A world of the one thing that a URDF text describes, called ``name``; its joints are held as they are.

    Raises RobotError.
    """
    root = _parse(description)
    for joint in root.iter("joint"):
        joint.set("type", "fixed")
    base = read_robot(ElementTree.tostring(root, encoding="unicode")).base
    return World(name, (Body(f"{name}::{base.name}", pose, base.collisions, base.mass),))


def frame_in_base(description: str, base: str, frame: str) -> np.ndarray:
    """Where a frame is fixed on the robot, (4, 4) in the frame ``base``. Raises RobotError."""
    root = _parse(description)
    joints = {_link_of(joint, "child"): joint for joint in root.iter("joint")}
    in_base, at = IDENTITY, frame
    while at != base:
        if at not in joints:
            raise RobotError(f"robot {root.get('name')}: no frame {frame} fixed on {base}")
        in_base = origin_of(joints[at]) @ in_base
        at = _link_of(joints[at], "parent")
    return in_base


def origin_of(element: ElementTree.Element) -> np.ndarray:
    """The pose (4, 4) of an element's <origin>; identity if it has none."""
    origin = element.find("origin")
    if origin is None:
        return IDENTITY
    return pose3(*_numbers(origin.get("xyz", "0 0 0")), *_numbers(origin.get("rpy", "0 0 0")))


def _parse(description: str) -> ElementTree.Element:
    try:
        return defusedxml.ElementTree.fromstring(description, forbid_dtd=False)
    except DefusedXmlException as error:
        raise RobotError(f"robot description: refused, defines entities ({type(error).__name__})") from None
    except (ElementTree.ParseError, ValueError) as error:
        raise RobotError(f"robot description: not well-formed XML ({error})") from None


def _numbers(text: str) -> List[float]:
    return [float(word) for word in text.split()]


def _link_of(joint: ElementTree.Element, end: str) -> str:
    element = joint.find(end)
    name = element.get("link") if element is not None else None
    if name is None:
        raise RobotError(f"joint {joint.get('name')}: <{end}> is missing")
    return name


def _wheel(joint: ElementTree.Element, link: ElementTree.Element, in_base: np.ndarray) -> Wheel:
    axis, limit = joint.find("axis"), joint.find("limit")
    if axis is None or limit is None:
        raise RobotError(f"joint {joint.get('name')}: a wheel needs <axis> and <limit effort='...'>")
    return Wheel(
        _merged([(link, IDENTITY)]),
        in_base,
        np.array(_numbers(axis.get("xyz", "1 0 0"))),
        float(limit.get("effort", "0")),
    )


def _merged(links: List[Tuple[ElementTree.Element, np.ndarray]]) -> Part:
    """Links (each with its pose) as one part: masses add up, inertias by the parallel axis theorem."""
    weights, centres, inertias, collisions = [], [], [], []
    for link, pose in links:
        for collision in link.iter("collision"):
            collisions.append(Collision(_shape(collision), pose @ origin_of(collision)))
        inertial = link.find("inertial")
        if inertial is not None:
            placed = pose @ origin_of(inertial)
            weights.append(float(inertial.find("mass").get("value")))  # type: ignore[union-attr,arg-type]
            centres.append(placed[:3, 3])
            inertias.append(placed[:3, :3] @ _inertia(inertial) @ placed[:3, :3].T)
    mass = sum(weights)
    if mass <= 0.0:
        raise RobotError(f"link {links[0][0].get('name')}: a part that moves needs a mass")
    centre = np.average(centres, axis=0, weights=weights)
    total = np.zeros(3)
    for weight, at, inertia in zip(weights, centres, inertias):
        arm = at - centre
        total += np.diag(inertia) + weight * (arm @ arm - arm * arm)
    return Part(links[0][0].get("name", ""), mass, centre, total, tuple(collisions))


def _inertia(inertial: ElementTree.Element) -> np.ndarray:
    element = inertial.find("inertia")
    if element is None:
        raise RobotError("an <inertial> lacks its <inertia>")
    xx, xy, xz, yy, yz, zz = (
        float(element.get(key, "0")) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    )
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _shape(collision: ElementTree.Element) -> Shape:
    for kind in collision.findall("geometry/*"):
        if kind.tag == "box":
            x, y, z = _numbers(kind.get("size", ""))
            return Box((x, y, z))
        if kind.tag == "cylinder":
            return Cylinder(float(kind.get("radius", "")), float(kind.get("length", "")))
        if kind.tag == "sphere":
            return Sphere(float(kind.get("radius", "")))
        raise RobotError(f"collision geometry <{kind.tag}> of a robot is not supported")
    raise RobotError("a <collision> lacks its <geometry>")
