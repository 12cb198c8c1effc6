"""Reads robot profiles from URDF and SDF."""

import xml.etree.ElementTree as ElementTree
from typing import Callable, Optional, Sequence, Tuple

import numpy as np

from sim_bridge.description.plugins import read_plugins
from sim_bridge.description.profile import RobotProfile
from sim_bridge.description.sdf import read_sdf
from sim_bridge.description.structure import GazeboElements, RobotStructure
from sim_bridge.description.urdf import FindFile, no_file, read_urdf
from sim_bridge.errors import NoDriveError, RobotError, WorldError
from sim_bridge.sdf.element import Element
from sim_bridge.sdf.supported import DRIVES
from sim_bridge.world import Body, DrivenModel, SurfaceProperties, World


def read_urdf_robot(text: str, where: str, find_file: FindFile = no_file) -> RobotProfile:
    """Read a robot from a URDF text.

    Args:
        text: The URDF.
        where: Name of the text in errors, e.g. its file.
        find_file: Finds the files of package:// and model:// URIs.

    Raises:
        NoDriveError: No plugin drives it.
        RobotError: The description cannot be used.
    """
    structure, elements = read_urdf(text, where, find_file)
    return _profile(structure, elements, text, where, _urdf_friction(elements.root))


def read_sdf_robot(model: DrivenModel) -> Tuple[RobotProfile, np.ndarray]:
    """Read a robot from a driven model of a world.

    Args:
        model: The model.

    Returns:
        The robot, and the pose (4, 4) of its base in the world.

    Raises:
        RobotError: The description cannot be used.
    """
    structure, elements, base_in_world = read_sdf(model)
    text = ElementTree.tostring(model.element.xml, encoding="unicode")
    friction = {body.name.split("::", 1)[1]: body.surface.friction for body in model.bodies}
    return _profile(structure, elements, text, model.element.file, friction.get), base_in_world


def read_prop(text: str, name: str, pose: np.ndarray, find_file: FindFile = no_file) -> World:
    """Return a world with one model: the object that a URDF text describes, with its joints fixed.

    Args:
        text: The URDF.
        name: Name of the model.
        pose: Pose (4, 4) in the world.
        find_file: Finds the files of package:// and model:// URIs.

    Raises:
        RobotError: The description cannot be used.
    """
    structure, elements = read_urdf(text, name, find_file)
    base = structure.assemble(()).base
    skipped, friction = elements.skipped, _urdf_friction(elements.root)(base.name)
    for plugin in elements.plugins:
        skipped.skip(plugin, "is not supported, ignored")
    for _, sensor in elements.sensors:
        skipped.skip(sensor)
    _skip_undriven_joints(elements, (), "fixed: the model has no drive")
    skipped.add_unread(elements.root)
    surface = SurfaceProperties() if friction is None else SurfaceProperties(friction)
    body = Body(f"{name}::{base.name}", pose, base.collisions, base.mass, surface)
    return World(name, (body,), warnings=tuple(skipped.lines()))


def _urdf_friction(robot: Element) -> Callable[[str], Optional[float]]:
    """Return a function from a link to its friction, None by default, in the <gazebo> elements of a URDF."""

    def friction_of(link: str) -> Optional[float]:
        given: Optional[float] = None
        for gazebo in robot.children("gazebo"):
            if gazebo.attribute("reference") == link:
                for tag in ("mu1", "mu2", "mu"):
                    if gazebo.child(tag) is not None:
                        mu = max(gazebo.number(tag, default=1.0), 0.0)
                        given = mu if given is None else min(given, mu)
        return given

    return friction_of


def _skip_undriven_joints(elements: GazeboElements, driven: Sequence[str], why: str) -> None:
    """Warn about movable joints that are fixed here; limits of fixed ones have no effect in Gazebo."""
    for joint in elements.root.children("joint"):
        limit = joint.child("limit")
        if joint.name in driven and limit is not None:
            limit.mark_all()  # Gazebo's drives set motors, which limits of the joint do not affect
        if joint.name in driven:
            continue
        if joint.attribute("type") == "fixed":
            joint.mark_all()
        else:
            elements.skipped.skip(joint, f"joint is {why}", kind="undriven joint")


def _profile(
    structure: RobotStructure,
    elements: GazeboElements,
    text: str,
    where: str,
    friction_of: Callable[[str], Optional[float]],
) -> RobotProfile:
    try:
        profiles = read_plugins(structure, elements)
        driven = () if profiles.drive is None else profiles.drive.joints
        wheels = [structure.joints[joint].child for joint in driven]
        given = {wheel: friction_of(wheel) for wheel in wheels}
        _skip_undriven_joints(elements, driven, "fixed: only driven wheels turn")
        elements.skipped.add_unread(elements.root)
    except WorldError as error:
        raise RobotError(str(error)) from None
    if profiles.drive is None:
        plugins = ", ".join(f"lib{name}.so" for name in DRIVES)
        raise NoDriveError(f"{where}: robot {structure.name} has no drive (a <gazebo> plugin of {plugins})")
    return RobotProfile(
        name=structure.name,
        text=text,
        model=structure.assemble(driven, {wheel: mu for wheel, mu in given.items() if mu is not None}),
        drive=profiles.drive,
        odometry=profiles.odometry,
        sensors=tuple(profiles.sensors),
        joint_states=profiles.joint_states,
        namespace=profiles.namespace,
        battery=profiles.battery,
        warnings=(*profiles.warnings, *elements.skipped.lines()),
    )
